// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// promin-lab robustness measures the cost of robustness: it compares promin's kernels with those of the textbook's
// methods (tools/plain/textbook), with rays and with pictures.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <span>

#include "lab/commands.h"
#include "lab/session.h"
#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "options/tracing_options.h"
#include "promin/error.h"
#include "promin/image.h"
#include "textbook_camera_stage.spv.h"
#include "textbook_cast.spv.h"
#include "textbook_follow_paths.spv.h"
#include "textbook_trace_shadow_rays.spv.h"
#include "trace/render/caster_access.h"
#include "trace/render/renderer_impl.h"

namespace promin::lab {
namespace {

namespace fs = std::filesystem;

uint64_t count_hits(std::span<const Hit> hits) {
  const auto is_hit = [](const Hit& hit) { return std::isfinite(hit.t); };
  return static_cast<uint64_t>(std::count_if(hits.begin(), hits.end(), is_hit));
}

void compare_casters(const Session& session, const world::Scene& scene, Json& rows) {
  const std::string name = scene.file.stem().string();
  session.say("robustness: " + name);
  Caster robust = make_caster(session.device(), scene);
  TunedCasterOptions options;
  options.spirv = k_textbook_cast_spirv;
  Caster plain = make_caster(session.device(), scene, options);
  const uint32_t side = session.side();
  const Camera camera = view_of(scene, uvec2(side)).camera;
  const bool is_closed = measure::is_generated_and_closed(scene);
  for (const measure::RaySet& set : measure::make_ray_sets(robust, scene, camera, side, is_closed)) {
    if (set.rays.empty()) continue;
    const measure::KernelPair pair = measure::measure_pair(robust, plain, set, session.runs());
    rows.push_back({{"scene", name},
                    {"rays", pair.rays},
                    {"count", pair.count},
                    {"promin_hits", count_hits(pair.robust_hits)},
                    {"textbook_hits", count_hits(pair.plain_hits)},
                    {"only_promin_hits", pair.count_only_robust()},
                    {"only_textbook_hits", pair.count_only_plain()},
                    {"robust_ms", pair.robust_ms},
                    {"plain_ms", pair.plain_ms},
                    {"time_ratio", measure::ratios_of(pair.robust_ms, pair.plain_ms)}});
  }
}

void measure_robustness(const LabOptions& options) {
  for (const std::string& scene : options.scenes) measure::open_scene(scene);
  const Session session(options);
  Json rows = Json::array();
  for (const std::string& scene : options.scenes) compare_casters(session, measure::open_scene(scene), rows);
  session.write("robustness", {{"rows", rows}});
}

/// Compares a picture that uses promin's methods with one that uses the textbook's methods. Both are timed in turns.
void compare_pictures(const LabOptions& options, const fs::path& folder, uint32_t samples) {
  world::Scene scene = measure::open_scene(options.scenes.front());
  add_default_lights(scene);
  if (!fs::is_directory(folder))
    throw RunError({"folder.missing", "the folder does not exist", folder.string(), "create it first"});
  const Session session(options);
  View view = view_of(scene, uvec2(session.side()));
  view.samples_per_pixel = samples;
  view.max_depth = options.max_depth;
  TunedRendererOptions textbook_options;
  textbook_options.shaders = {k_textbook_camera_stage_spirv, k_textbook_trace_shadow_rays_spirv,
                              k_textbook_follow_paths_spirv};
  std::array<Renderer, 2> renderers = {make_renderer(session.device(), scene),
                                       make_renderer(session.device(), scene, textbook_options)};
  std::array<Image, 2> images;
  std::vector<std::function<double()>> contestants;
  for (size_t i = 0; i < renderers.size(); ++i) {
    contestants.emplace_back([&, i] {
      RenderResult result = renderers[i].render(view);
      images[i] = std::move(result.image);
      return result.trace_ms;
    });
  }
  const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, session.runs());
  write_image(folder / "promin.exr", images[0]);
  write_image(folder / "textbook.exr", images[1]);
  fmt::print("{}\n", Json({{"promin_ms", ms[0]}, {"textbook_ms", ms[1]}}).dump());
}

}  // namespace

app::Command add_robustness_command(CLI::App& program) {
  CLI::App& command = app::add_command(program, "robustness",
                                       "Compares the rates of promin's kernel and of textbook methods, and counts rays "
                                       "that only one of them reports as hits");
  const auto options = std::make_shared<LabOptions>();
  options->runs = 5;
  app::OptionTable table(command);
  add_scenes(command, table, *options);
  add_measuring_options(table, *options, 1);
  return {&command, [options] { measure_robustness(*options); }};
}

app::Command add_methods_command(CLI::App& program) {
  CLI::App& command = app::add_command(
      program, "methods",
      "Renders a picture with promin's methods and with textbook methods, and measures the time of both");
  const auto options = std::make_shared<LabOptions>();
  const auto folder = std::make_shared<fs::path>();
  const auto samples = std::make_shared<uint32_t>(1);
  options->side = 512;
  app::OptionTable table(command);
  table.add_required("SCENE", "", "A scene file, or wavy:N or needles:N for a mesh of about N triangles",
                     [=](const app::OptionValues& words) { options->scenes = {words.text()}; });
  table.add_required("-o,--output", "FOLDER", "Folder to write promin.exr and textbook.exr to",
                     [=](const app::OptionValues& words) { *folder = words.text(); });
  app::add_device_option(table, options->device);
  table.add("--runs", "N", "Number of timed runs of each method after a warm-up [9]",
            [=](const app::OptionValues& words) { options->runs = words.whole(0, 1, 1000); });
  table.add("--side", "N", "Width and height of the picture in pixels [512]",
            [=](const app::OptionValues& words) { options->side = words.whole(0, 1, 4096); });
  table.add("--spp", "N", "Samples per pixel [1]",
            [=](const app::OptionValues& words) { *samples = words.whole(0, 1, kMaxSamplesPerPixel); });
  table.add("--max-depth", "N", "Largest number of mirror bounces [5]",
            [=](const app::OptionValues& words) { options->max_depth = words.whole(0, 0, kMaxDepth); });
  return {&command, [=] { compare_pictures(*options, *folder, *samples); }};
}

}  // namespace promin::lab
