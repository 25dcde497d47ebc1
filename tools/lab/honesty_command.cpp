// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// promin-lab honesty measures whether pictures with an error target are as exact as they claim. It compares their time
// with that of equally exact pictures with the same number of samples in each pixel. Whole pictures are timed. The true
// values are known for some windows of them, from many samples on a lattice, which the measured pictures do not use.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>

#include "core/stopwatch.h"
#include "lab/commands.h"
#include "measure/samples.h"
#include "promin/device.h"
#include "promin/framing.h"
#include "promin/lighting.h"
#include "promin/load_scene.h"
#include "promin/renderer.h"
#include "trace/film/pixel_estimate.h"
#include "trace/film/refinement.h"
#include "work/pictures/usual_integrator.h"
#include "work/pictures/view_setup.h"
#include "work/spec/value_words.h"

namespace promin::lab {
namespace {

struct HonestyOptions {
  std::string scene;
  uvec2 size{1280, 720};
  uint32_t truth_samples = 1024;
  uint32_t most_samples = 128;
  uint32_t runs = 3;
  /// True if errors and claims are those of the shown picture.
  bool is_shown = false;
  std::optional<std::string> pixels;
  LightChoice light = LightChoice::kAuto;
  Integrator integrator = Integrator::kWhitted;
};

/// The number of windows along each side of the picture, and the fraction of the side that they cover.
constexpr uint32_t kWindows = 5;
constexpr uint32_t kShare = 5;

std::vector<PixelWindow> choose_windows(const uvec2& size) {
  std::vector<PixelWindow> windows;
  const uvec2 cell = size / kWindows;
  const uvec2 side = glm::max(cell / kShare, uvec2(1));
  for (uint32_t i = 0; i < kWindows * kWindows; ++i) {
    const uvec2 lo = cell * uvec2(i % kWindows, i / kWindows) + (cell - side) / 2U;
    windows.push_back({lo, lo + side});
  }
  return windows;
}

/// Errors of the pixels whose true value is known.
struct Errors {
  double rmse = 0.0;
  /// The error of the mean of all pixels, relative to the mean.
  double bias = 0.0;
  /// The error that 999 of 1000 pixels do not exceed. A pixel's error is that of its worst channel.
  double worst = 0.0;
};

/// The time and the errors of a picture.
struct Point {
  double ms = 0.0;
  Errors errors;
};

class HonestyBench {
 public:
  HonestyBench(const gpu::Device& device, const std::string& file, const HonestyOptions& options)
      : options_(options), windows_(choose_windows(options.size)), name_(std::filesystem::path(file).stem()) {
    Scene scene = load_scene(file);
    work::LookOptions look{.light = options.light};
    work::settle_light(scene, options.integrator, look);
    work::light_up(scene, look);
    const float aspect_ratio = static_cast<float>(options.size.x) / static_cast<float>(options.size.y);
    view_.camera = scene.cameras.empty() ? frame_scene(scene, aspect_ratio) : scene.cameras.front();
    view_.size = options.size;
    if (options.pixels) {
      pixels_.emplace(*options.pixels);
      *pixels_ << "scene,target,claim,error\n";
    }
    if (options.is_shown) display_ = work::choose_display(scene, look, DebugView::kNone);
    view_.max_depth = default_max_depth(scene);
    view_.mode.integrator = options.integrator;
    renderer_.emplace(device, scene, RendererOptions{.with_aovs = true});
    plain_renderer_.emplace(device, scene);
  }

  void run() {
    find_truth();
    std::vector<View> views;
    for (uint32_t samples = 1; samples <= options_.most_samples; samples *= 2) {
      views.push_back(view_);
      views.back().samples_per_pixel = samples;
    }
    const size_t uniform_count = views.size();
    for (const float error : {1.0F / 16.0F, 1.0F / 32.0F, 1.0F / 64.0F, 1.0F / 128.0F}) {
      views.push_back(view_);
      views.back().error_target =
          ErrorTarget{.error = error, .min_samples = usual_min_samples(error), .display = display_};
    }
    std::vector<RenderResult> results(views.size());
    std::vector<std::function<double()>> contestants;
    for (size_t i = 0; i < views.size(); ++i) {
      contestants.emplace_back([&, i] {
        // The time includes the host's work between dispatches, which is larger if pixels are refined.
        const Stopwatch rendering;
        results[i] = plain_renderer_->render(views[i]);
        return rendering.ms();
      });
    }
    const std::vector<std::vector<double>> times = measure::time_in_turns(contestants, options_.runs);
    std::vector<Point> uniform;
    for (size_t i = 0; i < views.size(); ++i) {
      const Point point{measure::quartiles_of(times[i]).median, errors_of(results[i].image)};
      if (i < uniform_count) {
        uniform.push_back(point);
        tell(fmt::format("{} spp", views[i].samples_per_pixel), views[i].samples_per_pixel, point);
      } else {
        const double pixels = static_cast<double>(view_.size.x) * view_.size.y;
        tell(fmt::format("error 1/{:g}", 1.0 / static_cast<double>(views[i].error_target->error)),
             static_cast<double>(results[i].error->samples) / pixels, point);
        fmt::print(" {:.2f} % | {} | {} |\n", 100.0 * honest_share(views[i]),
                   ratio_to(uniform, point, [](const Point& p) { return p.errors.rmse; }),
                   ratio_to(uniform, point, [](const Point& p) { return p.errors.worst; }));
        continue;
      }
      fmt::print(" | | |\n");
    }
  }

 private:
  void find_truth() {
    View fine = view_;
    fine.samples_per_pixel = options_.truth_samples;
    // Points of lights are those of another seed, so that the truth does not share its error with the pictures.
    if (view_.mode.integrator != Integrator::kWhitted) fine.seed = view_.seed + 1;
    for (const PixelWindow& window : windows_) {
      fine.crop = window;
      truth_.push_back(plain_renderer_->render(fine).image);
    }
  }

  /// Returns a color in the units in which errors are measured.
  vec3 shown(const vec3& color) const { return display_ ? shown_color(color, *display_) : color; }

  Errors errors_of(const Image& image) const {
    double sum2 = 0.0;
    double mean = 0.0;
    double true_mean = 0.0;
    std::vector<double> worst;
    for (size_t w = 0; w < windows_.size(); ++w) {
      for (uint32_t y = 0; y < truth_[w].size.y; ++y) {
        for (uint32_t x = 0; x < truth_[w].size.x; ++x) {
          const vec3& written = image.at(windows_[w].lo.x + x, windows_[w].lo.y + y);
          const dvec3 color(shown(written));
          const dvec3 true_color(shown(truth_[w].at(x, y)));
          const dvec3 error = color - true_color;
          mean += color.x + color.y + color.z;
          true_mean += true_color.x + true_color.y + true_color.z;
          sum2 += glm::dot(error, error);
          worst.push_back(std::max({std::abs(error.x), std::abs(error.y), std::abs(error.z)}));
        }
      }
    }
    const auto at = worst.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(worst.size()));
    std::nth_element(worst.begin(), at, worst.end());
    const double bias = true_mean == 0.0 ? 0.0 : mean / true_mean - 1.0;
    return {std::sqrt(sum2 / (3.0 * static_cast<double>(worst.size()))), bias, *at};
  }

  /// Returns the fraction of the refined pixels whose error is within the claim.
  double honest_share(View view) {
    std::vector<RenderResult> results;
    uint32_t first_samples = view.error_target->max_samples;
    for (const PixelWindow& window : windows_) {
      view.crop = window;
      results.push_back(renderer_->render(view));
      first_samples = std::min(first_samples, std::ranges::min(results.back().aovs.samples));
    }
    size_t refined = 0;
    size_t honest = 0;
    for (size_t w = 0; w < windows_.size(); ++w) {
      const RenderResult& result = results[w];
      for (size_t i = 0; i < truth_[w].pixels.size(); ++i) {
        if (result.aovs.samples[i] == first_samples) continue;
        ++refined;
        const vec3& written = result.image.pixels[i];
        const vec3 claim = display_ ? shown_claim(result.aovs.error[i], written, *display_) : result.aovs.error[i];
        const vec3 error = glm::abs(shown(written) - shown(truth_[w].pixels[i]));
        honest += glm::all(glm::lessThanEqual(error, claim)) ? 1 : 0;
        write_pixel(view.error_target->error, claim, error);
      }
    }
    return static_cast<double>(honest) / static_cast<double>(std::max<size_t>(refined, 1));
  }

  /// Writes the claim and the error of a pixel's channel with the largest error.
  void write_pixel(float target, const vec3& claim, const vec3& error) {
    if (!pixels_) return;
    const int worst = error.y > error.x ? (error.z > error.y ? 2 : 1) : (error.z > error.x ? 2 : 0);
    *pixels_ << fmt::format("{},{:.9g},{:.9g},{:.9g}\n", name_, target, claim[worst], error[worst]);
  }

  /// Returns the ratio of a picture's time to the time of an unrefined picture with the same error. That time is
  /// interpolated between pictures whose numbers of samples per pixel are powers of two. The interpolation is linear in
  /// the logarithms.
  template <typename Error>
  static std::string ratio_to(const std::vector<Point>& uniform, const Point& point, const Error& error_of) {
    for (size_t i = 1; i < uniform.size(); ++i) {
      const double above = std::log(error_of(uniform[i - 1]));
      const double below = std::log(error_of(uniform[i]));
      const double wanted = std::log(error_of(point));
      if (wanted > above || wanted < below) continue;
      const double share = (above - wanted) / (above - below);
      return fmt::format("{:.3f}",
                         point.ms / std::exp(std::lerp(std::log(uniform[i - 1].ms), std::log(uniform[i].ms), share)));
    }
    return error_of(point) < error_of(uniform.back()) ? fmt::format("< {:.3f}", point.ms / uniform.back().ms) : "-";
  }

  void tell(const std::string& what, double samples, const Point& point) const {
    fmt::print("| {} | {} | {:.2f} | {:.0f} | {:.5f} | {:.4f} | {:+.2f} % |", name_, what, samples, point.ms,
               point.errors.rmse, point.errors.worst, 100.0 * point.errors.bias);
    std::fflush(stdout);
  }

  HonestyOptions options_;
  std::vector<PixelWindow> windows_;
  std::string name_;
  View view_;
  std::optional<DisplayTransform> display_;
  std::optional<Renderer> renderer_;
  std::optional<Renderer> plain_renderer_;
  std::vector<Image> truth_;
  /// The table of pixels, if one is requested.
  std::optional<std::ofstream> pixels_;
};

void measure_honesty(const HonestyOptions& options) {
  const gpu::DeviceHandle device = gpu::open_device();
  fmt::print(
      "| scene | picture | samples a pixel | ms | RMSE | 99.9 % error | error of the mean | within the claim | time "
      "over uniform sampling's of equal RMSE | of equal 99.9 % error |\n|---|---|---|---|---|---|---|---|---|---|\n");
  HonestyBench(*device, options.scene, options).run();
}

}  // namespace

app::Command add_honesty_command(CLI::App& program) {
  using app::OptionValues;
  CLI::App& command = app::add_command(program, "honesty",
                                       "Compares the true errors of pictures with a target error with their claimed "
                                       "errors, and their times with uniform sampling");
  const auto options = std::make_shared<HonestyOptions>();
  app::OptionTable table(command);
  table.add_required("SCENE", "", "Scene to render", [=](const OptionValues& words) { options->scene = words.text(); });
  table.add("--size", "WxH", "Size of the pictures; sides of less than 25 become 25 [1280x720]",
            [=](const OptionValues& words) { options->size = glm::max(words.read(work::read_size), uvec2(25)); });
  table.add("--truth", "N", "Samples per pixel of the reference picture, 64 to 65535 [1024]",
            [=](const OptionValues& words) { options->truth_samples = words.whole(0, 64, kMaxSamplesPerPixel); });
  table.add("--most", "N", "Largest number of samples per pixel of the uniform pictures, 2 to 1024 [128]",
            [=](const OptionValues& words) { options->most_samples = words.whole(0, 2, 1024); });
  table.add("--runs", "N", "Number of runs, whose median is reported, 1 to 99 [3]",
            [=](const OptionValues& words) { options->runs = words.whole(0, 1, 99); });
  const std::span<const std::string_view> lights = light_choice_names();
  table.add("--light", fmt::format("{}", fmt::join(lights.subspan(1), "|")), "Light of scenes without light [auto]",
            [=](const OptionValues& words) { options->light = words.name<LightChoice>(lights, 1); });
  table.add("--integrator", fmt::format("{}", fmt::join(integrator_names(), "|")),
            "Method that computes light [whitted]",
            [=](const OptionValues& words) { options->integrator = words.name<Integrator>(integrator_names()); });
  table.add("--pixels", "FILE.csv", "Write the claim and the error of each refined pixel, for honesty_plot.py",
            [=](const OptionValues& words) { options->pixels = words.text(); });
  table.add_flag("--shown", "Measure errors in the displayed picture (--error-in display) instead of linear light",
                 options->is_shown);
  return {&command, [options] { measure_honesty(*options); }};
}

}  // namespace promin::lab
