// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/check_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "core/file.h"
#include "image/picture_endings.h"
#include "promin/aovs.h"
#include "promin/error.h"
#include "promin/image.h"
#include "work/pictures/camera_path.h"
#include "work/pictures/film_file.h"
#include "work/pictures/frame_plan.h"

namespace promin::work {
namespace {

/// An option, or a group of options that counts as one: whether it is given, and its name.
using Given = std::pair<bool, std::string_view>;

void refuse_if(ProblemCode code, bool holds, const std::string& what, const std::string& cure) {
  if (holds) throw UsageError({code, what, "", cure});
}

/// Refuses the first of the other options that is given in addition to `name`.
void refuse_beside(std::string_view name, std::initializer_list<Given> others,
                   const std::string& cure = "remove one of them") {
  for (const auto& [is_given, other] : others) {
    refuse_if("usage.options.contradict", is_given, fmt::format("{} and {} contradict each other", name, other), cure);
  }
}

}  // namespace

void check_motion_options(const MotionOptions& motion, bool has_frames) {
  refuse_if("usage.option.needs", motion.loops && !motion.time_s && !has_frames, "--loop needs a time",
            "give --time as well");
  if (motion.animations.size() < 2) return;
  for (const char* word : {MotionOptions::kAll, MotionOptions::kNone}) {
    refuse_if("usage.options.contradict", std::ranges::count(motion.animations, word) > 0,
              fmt::format("--animation {} and the name of an animation contradict each other", word),
              "remove one of them");
  }
}

void check_tracing_options(const TracingOptions& options, bool has_frames) {
  check_motion_options(options.motion, has_frames);
  if (options.bvh) refuse_beside("--bvh", {{options.builder.has_value(), "--builder"}});
}

void check_pose_options(const PoseOptions& pose, bool names_camera) {
  const bool has_eye = pose.eye.has_value();
  const bool has_look_at = pose.look_at.has_value();
  if (has_look_at) refuse_beside("--look-at", {{pose.direction.has_value(), "--direction"}});
  if (pose.from) {
    refuse_beside("--from", {{names_camera, "--camera"},
                             {has_eye, "--eye"},
                             {has_look_at, "--look-at"},
                             {pose.direction.has_value(), "--direction"}});
  }
  if (pose.fit) {
    refuse_beside("--fit", {{names_camera, "--camera"},
                            {has_eye, "--eye"},
                            {has_look_at, "--look-at"},
                            {pose.from == Framing::kInside, "--from inside"}});
  }
}

namespace {

void check_has_job(const JobOptions& job) {
  if (job.folder) return;
  const std::string_view name = job.share ? "--piece" : job.tiles ? "--tiles" : job.pieces ? "--pieces" : "";
  if (name.empty()) return;
  throw UsageError({"usage.option.needs", fmt::format("{} needs a job to divide", name), "", "give --job as well"});
}

}  // namespace

void check_error_target(const ErrorTarget& target) {
  if (target.min_samples <= target.max_samples) return;
  throw UsageError({"usage.options.range",
                    fmt::format("--min-spp {} is more than --max-spp {}", target.min_samples, target.max_samples), "",
                    "raise --max-spp or lower --min-spp"});
}

void check_no_camera(const ViewOptions& options, std::string_view name) {
  if (!options.camera && !options.pose.any()) return;
  throw UsageError(
      {"usage.options.contradict",
       fmt::format("{} and options of the camera (--camera, --from, --eye, --look-at and others) contradict each other",
                   name),
       "", "remove one of them"});
}

namespace {

bool shades_for_debugging(const RenderSpec& options) {
  return options.view.debug_view != DebugView::kNone;
}

/// Returns the AOVs that only an EXR can store.
AovSet named_aovs(const RenderSpec& options) {
  AovSet named = options.aovs;
  named.alpha = false;
  return named;
}

void check_explanation(const RenderSpec& options) {
  const ErrorOptions& error = options.error;
  const ViewOptions& view = options.view;
  const bool is_debug = shades_for_debugging(options);
  if (!options.explained_pixel) return;
  refuse_beside("--explain", {{!options.pictures.empty(), "--output"},
                              {options.path.has_value(), "--path"},
                              {options.turntable.has_value(), "--turntable"},
                              {options.frames.has_value(), "--frames"},
                              {options.fps.has_value(), "--fps"},
                              {options.shutter.has_value(), "--shutter"},
                              {options.aovs.any(), "--aov"},
                              {view.crop.has_value(), "--crop"},
                              {is_debug, "--shading"},
                              {error.target.has_value(), "--target-error"},
                              {error.time_limit_s.has_value(), "--time-limit"},
                              {options.tracing.stats.has_value(), "--stats"},
                              {options.tracing.repeat_count > 1, "--repeat"}});
}

void check_quality(const RenderSpec& options) {
  const ErrorOptions& error = options.error;
  const ViewOptions& view = options.view;
  if (options.quality) {
    refuse_beside("--quality", {{view.samples_per_pixel.has_value(), "--spp"},
                                {error.target.has_value(), "--target-error"},
                                {error.time_limit_s.has_value(), "--time-limit"}});
  }
}

/// Refuses options that contradict an error target.
void check_target(const RenderSpec& options) {
  const ErrorOptions& error = options.error;
  const ViewOptions& view = options.view;
  const bool is_debug = shades_for_debugging(options);
  const bool averages = view.look.averages_exposure;
  const std::string_view name = error.target ? "--target-error" : "--time-limit";
  refuse_beside(name, {{view.samples_per_pixel.has_value(), "--spp"}},
                "remove one of them; --min-spp and --max-spp limit the samples of --target-error");
  refuse_beside(name, {{is_debug, "--shading"}});
  // Each repetition could reach another target, and its picture would then differ.
  if (error.time_limit_s) refuse_beside("--time-limit", {{options.tracing.repeat_count > 1, "--repeat"}});
  refuse_if("usage.options.contradict", error.space == ErrorSpace::kDisplay && averages,
            "--error-in display and --exposure average contradict each other, because the average is known only after "
            "tracing",
            "give --exposure in stops");
  check_error_target(*error.error_target());
}

/// Refuses options that need an error target or light if the picture has none.
void check_fixed_samples(const RenderSpec& options) {
  const ErrorOptions& error = options.error;
  const bool is_debug = shades_for_debugging(options);
  const AovSet named = named_aovs(options);
  refuse_if("usage.options.contradict", (named.has_any(AovSource::kParts) || named.unlit) && is_debug,
            "--shading and an --aov of light contradict each other, because a debug shading computes no light",
            "remove one of them");
  refuse_if("usage.options.contradict", options.aovs.error && is_debug,
            "--shading and --aov error contradict each other, because a debug shading has no error estimate",
            "remove one of them");
  for (const auto& [is_given, name] : {Given{error.min_samples.has_value(), "--min-spp"},
                                       {error.max_samples.has_value(), "--max-spp"},
                                       {error.space.has_value(), "--error-in"}}) {
    refuse_if("usage.option.needs", is_given, fmt::format("{} needs a target error", name),
              "give --target-error as well");
  }
}

void check_job(const RenderSpec& options) {
  const ErrorOptions& error = options.error;
  const JobOptions& job = options.job;
  const bool averages = options.view.look.averages_exposure;
  check_has_job(job);
  if (!job.folder) return;
  refuse_beside("--job", {{options.explained_pixel.has_value(), "--explain"},
                          {error.time_limit_s.has_value(), "--time-limit"},
                          {averages, "--exposure average"},
                          {options.skips_existing, "--skip-existing"},
                          {options.tracing.stats.has_value(), "--stats"},
                          {options.tracing.repeat_count > 1, "--repeat"}});
  if (job.pieces) refuse_beside("--pieces", {{job.tiles.has_value(), "--tiles"}});
  refuse_if("usage.options.contradict", job.share && !options.pictures.empty(),
            "--piece and --output contradict each other, because --piece writes no picture",
            "remove one of them; promin merge writes the picture when all pieces are made");
}

/// Refuses options of motion that the pictures do not support.
void check_motion_options(const RenderSpec& options) {
  const bool moves = options.moves_scene() || options.moves_camera();
  const std::string cure = "give --frames, --fps, --path or --turntable as well";
  refuse_if("usage.option.needs", options.aovs.motion && !moves, "--aov motion needs frames that move", cure);
  if (!options.shutter) return;
  const ErrorOptions& error = options.error;
  refuse_if("usage.option.needs", !moves, "--shutter needs frames that move", cure);
  refuse_beside("--shutter", {{error.target.has_value(), "--target-error"},
                              {error.time_limit_s.has_value(), "--time-limit"},
                              {options.quality == Quality::kBest, "--quality best"},
                              {options.aovs.error, "--aov error"},
                              {options.tracing.repeat_count > 1, "--repeat"}});
}

void check_frames(const RenderSpec& options) {
  const bool averages = options.view.look.averages_exposure;
  refuse_if("usage.option.needs", options.skips_existing && options.pictures.empty(),
            "--skip-existing needs the names of the pictures", "give -o as well");
  refuse_if("usage.options.contradict", options.skips_existing && averages,
            "--skip-existing and --exposure average contradict each other, because promin takes the average from the "
            "first frame",
            "give --exposure in stops");
  const bool is_stored = options.fps == PathPictures::kStored;
  refuse_if("usage.option.needs", is_stored && !options.path, "--fps stored needs a camera path",
            "give --path as well");
  if (!options.moves_scene()) return;
  const MotionOptions& motion = options.tracing.motion;
  const std::string_view name = options.frames      ? "--frames"
                                : options.fps       ? "--fps"
                                : options.turntable ? "--turntable"
                                                    : "--path";
  refuse_beside(name, {{motion.time_s.has_value(), "--time"},
                       {motion.chooses_none(), "--animation none"},
                       {options.tracing.bvh.has_value(), "--bvh"}});
  refuse_if("usage.options.contradict", averages,
            "--exposure average and the frames of an animation contradict each other, because the exposure belongs to "
            "the whole animation",
            "give --exposure in stops");
}

/// Refuses channels that none of the pictures can store.
void check_channels(const RenderSpec& options) {
  const AovSet named = named_aovs(options);
  const bool has_depth_kind = options.view.depth_kind != DepthKind::kRay;
  const auto& pictures = options.pictures;
  const std::string stem = options.tracing.scene.stem().string();
  const bool has_exr = pictures.empty() || std::ranges::any_of(pictures, has_named_channels);
  for (const auto& [is_given, name] : {Given{named.any(), "--aov"},
                                       {has_depth_kind, "--depth"},
                                       {options.exr.is_half, "--half"},
                                       {options.names_compression, "--compression"}}) {
    refuse_if("usage.option.needs", is_given && !has_exr, fmt::format("{} needs an EXR", name),
              fmt::format("add -o {}.exr", stem));
  }
  refuse_if("usage.option.needs", has_depth_kind && !options.aovs.depth, "--depth needs the AOV depth",
            "give --aov depth as well");
}

void check_alpha(const RenderSpec& options) {
  const ViewOptions& view = options.view;
  const bool is_debug = shades_for_debugging(options);
  const auto& pictures = options.pictures;
  if (!options.aovs.alpha) return;
  refuse_beside("--alpha", {{is_debug, "--shading"}});
  refuse_beside("--alpha", {{view.look.background.has_value(), "--background"}},
                "remove --background, because --alpha makes the background transparent");
  refuse_if("output.alpha.none", std::ranges::any_of(pictures, is_jpeg), "a JPEG cannot store the channel of --alpha",
            "write a .png or .exr");
  refuse_if("output.alpha.none", std::ranges::any_of(pictures, is_radiance),
            "a .hdr cannot store the channel of --alpha", "write a .png or .exr");
  const auto is_mp4 = [](const std::filesystem::path& file) { return is_film(file) && !film_stores_alpha(file); };
  refuse_if("output.alpha.none", std::ranges::any_of(pictures, is_mp4), "an MP4 cannot store the channel of --alpha",
            "write a .webm or .gif, or an animated .png");
}

/// Throws UsageError if options for a PNG are given without a PNG.
void check_dither(const RenderSpec& options) {
  const ViewOptions& view = options.view;
  const auto& pictures = options.pictures;
  const std::string stem = options.tracing.scene.stem().string();
  const bool has_png = pictures.empty() || !std::ranges::all_of(pictures, has_named_channels);
  refuse_if("usage.option.needs", view.look.dithers && !has_png, "--dither needs a PNG",
            fmt::format("add -o {}.png", stem));
}

}  // namespace

void check_lens(const ViewOptions& view) {
  const bool has_lens = view.aperture_radius.value_or(0.0) > 0.0;
  refuse_if("usage.option.needs", has_lens && !view.focus_distance, "--aperture-radius needs a plane in focus",
            "give --focus-distance as well");
  refuse_if("usage.option.needs", view.focus_distance && !view.aperture_radius, "--focus-distance needs a lens",
            "give --aperture-radius as well");
}

// The checks have the order in which contradictions are reported.
void check_render_spec(const RenderSpec& options) {
  check_tracing_options(options.tracing, options.moves_scene());
  check_pose_options(options.view.pose, options.view.camera.has_value());
  if (options.path) check_no_camera(options.view, "--path");
  if (options.turntable) refuse_beside("--turntable", {{options.path.has_value(), "--path"}});
  check_lens(options.view);
  check_explanation(options);
  check_quality(options);
  if (options.error.is_given()) {
    check_target(options);
  } else {
    check_fixed_samples(options);
  }
  check_job(options);
  check_frames(options);
  check_motion_options(options);
  check_channels(options);
  check_alpha(options);
  check_dither(options);
}

namespace {

void check_query(const CastSpec& options) {
  std::vector<std::string> asked;
  if (options.is_any) asked.emplace_back("--any");
  if (options.is_count) asked.emplace_back("--count");
  if (options.is_all) asked.emplace_back("--all");
  if (asked.size() > 1) {
    throw UsageError(
        {"usage.options.contradict", asked[0] + " and " + asked[1] + " contradict each other", "", "give one of them"});
  }
  refuse_if("usage.option.needs", options.is_all && !options.offsets && !options.job.share,
            "--all is given without --offsets",
            "add --offsets OFFSETS.npy, a file of the indices at which the hits of each ray begin");
  refuse_if("usage.option.needs", options.offsets && !options.is_all, "--offsets is given without --all",
            "add --all or remove --offsets");
}

void check_job_options(const CastSpec& options) {
  check_has_job(options.job);
  if (!options.output && !options.job.share) {
    throw UsageError({"usage.option.required", "--output is required", "", "see promin cast --help"});
  }
  if (!options.job.folder) return;
  refuse_beside("--job",
                {{options.tracing.stats.has_value(), "--stats"}, {options.tracing.repeat_count > 1, "--repeat"}});
  refuse_if("usage.options.contradict", options.job.share && !options.outputs().empty(),
            "--piece and --output contradict each other, because --piece writes no file",
            "remove one of them; promin merge writes the file when all pieces are made");
}

}  // namespace

void check_arrays(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    if (lower_case_ending(file) == ".npy") continue;
    throw UsageError({"output.extension", "the output's extension \"" + file.extension().string() + "\" is unknown",
                      file.string(), "use .npy"});
  }
}

void check_cast_spec(const CastSpec& options) {
  check_tracing_options(options.tracing);
  check_query(options);
  check_job_options(options);
  check_arrays(options.outputs());
}

namespace {

[[noreturn]] void refuse_ending(const std::filesystem::path& file, const std::string& cure) {
  throw UsageError({"output.extension", "the output's extension \"" + file.extension().string() + "\" is unknown",
                    file.string(), cure});
}

}  // namespace

void check_pictures(const std::vector<std::filesystem::path>& pictures) {
  for (const std::filesystem::path& picture : pictures) {
    if (!is_writable_format(picture)) refuse_ending(picture, kUseKnownEnding);
  }
}

void check_frame_files(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    if (!is_writable_format(file) && !is_film(file)) {
      refuse_ending(file, std::string(kUseKnownEnding) + ", or .mp4, .webm or .gif for a film");
    }
    if (is_film(file) && number_file(file, 0) != file) {
      throw UsageError({"output.film.number", "the name of a film has a # for the number of a frame", file.string(),
                        "remove it, because a film holds all frames"});
    }
  }
}

}  // namespace promin::work
