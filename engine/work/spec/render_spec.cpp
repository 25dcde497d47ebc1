// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/render_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/count_of.h"
#include "promin/error.h"
#include "trace/film/refinement.h"
#include "work/pictures/film_file.h"
#include "work/pictures/moving_scene.h"

namespace promin::work {

std::vector<std::filesystem::path> input_files(const TracingOptions& options) {
  std::vector<std::filesystem::path> files = {options.scene};
  if (options.bvh) files.push_back(*options.bvh);
  return files;
}

std::filesystem::path shared_tree_file(const JobOptions& job, const std::string& builder) {
  return *job.folder / "trees" / (builder + ".pbvh");
}

std::span<const std::string_view> quality_names() {
  using std::string_view_literals::operator""sv;
  static constexpr std::array kNames = {"draft"sv, "normal"sv, "high"sv, "best"sv};
  return kNames;
}

std::string least_error() {
  return fmt::format("1/{:g}", 1.0F / kMinTargetError);
}

std::span<const std::string_view> error_space_names() {
  static constexpr std::array kNames = {std::string_view("linear"), std::string_view("display")};
  return kNames;
}

std::optional<ErrorTarget> ErrorOptions::error_target() const {
  if (!is_given()) return {};
  return target_or(kMinTargetError);
}

ErrorTarget ErrorOptions::target_or(float error) const {
  ErrorTarget result;
  result.error = target.value_or(error);
  if (target && !time_limit_s) result.min_samples = usual_min_samples(*target);
  result.min_samples = min_samples.value_or(std::min(result.min_samples, max_samples.value_or(result.min_samples)));
  result.max_samples = max_samples.value_or(std::max(result.max_samples, result.min_samples));
  if (space == ErrorSpace::kDisplay) result.display.emplace();
  return result;
}

void fit_to_display(ErrorTarget& target, const DisplayTransform& display) {
  target.white = std::exp2(-display.exposure_ev);
  if (target.display) target.display = display;
}

std::string describe_options(const ErrorTarget& target) {
  return fmt::format("--target-error {} --min-spp {} --max-spp {}{}", target.error, target.min_samples,
                     target.max_samples, target.display ? " --error-in display" : "");
}

std::string describe_errors(float least, float most, const ErrorTarget& target) {
  const std::string to = least == most ? "" : fmt::format(" to {}", most);
  return fmt::format("error {}{}{}", least, to, target.display ? " as shown" : "");
}

std::string describe_unmet(const PictureError& error) {
  if (error.unmet_pixels == 0) return "";
  return fmt::format(" but for {} of at most {:.3g}", count_of(error.unmet_pixels, "pixel"), error.largest_claim);
}

namespace {

/// Number of samples of the quality `best` for pictures without an error target: pictures with a debug shading or
/// --exposure average.
constexpr uint32_t kBestSamples = 128;
/// Target error of the quality `best`: one 8-bit code of the displayed colours.
constexpr float kBestError = 1.0F / 256.0F;

}  // namespace

bool RenderSpec::names_film() const {
  return std::ranges::any_of(pictures, is_film);
}

void complete_film(RenderSpec& options) {
  if (options.names_film() && !options.moves_camera() && !options.frames && !options.fps) options.fps = kDefaultFps;
}

uint32_t samples_of(Quality quality, const RenderMode& mode) {
  static constexpr std::array kSamples = {1U, kDefaultSamples, kHighSamples, kBestSamples};
  const bool has_noise = mode.debug_view == DebugView::kNone && mode.integrator != Integrator::kWhitted;
  return kSamples[static_cast<size_t>(quality)] * (has_noise ? kNoiseFactor : 1);
}

void apply_quality(RenderSpec& options) {
  ViewOptions& view = options.view;
  if (options.error.is_given() || view.samples_per_pixel) return;
  if (options.explained_pixel && !options.quality) {
    view.samples_per_pixel = 1;
    return;
  }
  const Quality quality = options.quality.value_or(Quality::kNormal);
  if (quality == Quality::kBest && view.debug_view == DebugView::kNone && !view.look.averages_exposure) {
    options.error.target = kBestError;
    options.error.space = ErrorSpace::kDisplay;
    return;
  }
  view.samples_per_pixel = samples_of(
      quality, {.debug_view = view.debug_view, .integrator = view.integrator.value_or(Integrator::kWhitted)});
}

std::vector<std::filesystem::path> name_pictures(const RenderSpec& options) {
  if (!options.pictures.empty() || options.explained_pixel || options.job.share) return options.pictures;
  const std::string stem =
      options.tracing.scene.stem().string() + (options.moves_camera() || options.makes_film() ? ".####" : "");
  return {stem + ".exr", stem + ".png"};
}

}  // namespace promin::work
