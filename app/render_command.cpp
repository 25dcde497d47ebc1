// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render_command.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <memory>

#include "console.h"
#include "core/error.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "deferred_signals.h"
#include "gpu/open_device.h"
#include "image/image.h"
#include "outputs.h"
#include "progress.h"
#include "render_options.h"
#include "scene/load_scene.h"
#include "stats.h"
#include "view_setup.h"

namespace promin::app {
namespace {

/// Sets the renderer up, traces as often as asked for and leaves what it took in `stats`.
Image trace(const gpu::Device& device, const Scene& scene, const RenderOptions& options, RenderStats& stats,
            const Console& console) {
  RendererOptions renderer_options;
  renderer_options.builder = options.builder;
  renderer_options.force_all_features = options.has_all_features;
  Renderer renderer(device, scene, renderer_options);
  stats.setup = renderer.setup_stats();
  console.detail(fmt::format("BVH by {}: {} nodes, depth {}, SAH cost {:.4g}, {:.1f} ms", stats.setup.bvh.builder,
                             stats.setup.bvh.nodes, stats.setup.bvh.depth, stats.setup.bvh.sah_cost,
                             stats.setup.bvh_ms));
  console.detail(fmt::format("features: {}", fmt::join(feature_names(stats.setup.features), ", ")));
  console.detail(fmt::format("upload {:.1f} ms ({:.1f} MB), pipeline {:.1f} ms", stats.setup.upload_ms,
                             1e-6 * static_cast<double>(stats.setup.device_bytes), stats.setup.pipeline_ms));

  RenderResult result;
  Progress progress(console.is_quiet());
  for (uint32_t i = 0; i < options.repeat_count; ++i) {
    result =
        renderer.render(stats.view, [&](double fraction) { progress.update((i + fraction) / options.repeat_count); });
    stats.trace_ms.push_back(result.trace_ms);
  }
  stats.rays = result.rays;
  return std::move(result.image);
}

Metadata make_metadata(const RenderStats& stats) {
  return {{"promin:version", PROMIN_VERSION},
          {"promin:scene", stats.scene_file},
          {"promin:device", stats.device.name},
          {"promin:driver", stats.device.driver},
          {"promin:size", fmt::format("{}x{}", stats.view.size.x, stats.view.size.y)},
          {"promin:spp", std::to_string(stats.view.samples_per_pixel)},
          {"promin:max_depth", std::to_string(stats.view.max_depth)},
          {"promin:trace_ms", fmt::format("{:.3f}", stats.median_trace_ms())}};
}

void write_pictures(const std::vector<std::filesystem::path>& files, const Image& image, const RenderStats& stats) {
  std::optional<CropPlacement> placement;
  if (stats.view.crop) placement = CropPlacement{stats.view.crop->lo, stats.view.size};
  const Metadata metadata = make_metadata(stats);
  for (const std::filesystem::path& file : files) write_image(file, image, metadata, placement);
}

std::string summarize(const RenderStats& stats, const RenderOptions& options) {
  std::vector<std::string> files;
  for (const std::filesystem::path& file : options.pictures) files.push_back(file.string());
  return fmt::format("{}x{}, {} spp, {:.4g} Mrays in {:.1f} ms ({:.3g} Mrays/s) on {}: {}", stats.view.size.x,
                     stats.view.size.y, stats.view.samples_per_pixel, 1e-6 * static_cast<double>(stats.rays.total()),
                     stats.median_trace_ms(), stats.mrays_per_s(), stats.device.name, fmt::join(files, ", "));
}

void render(const RenderOptions& options) {
  const Stopwatch total;
  check_render_options(options);
  check_outputs(options.scene, options.pictures, options.stats);
  const Console console(options.verbosity());

  RenderStats stats;
  const Stopwatch load;
  Scene scene = load_scene(options.scene);
  stats.load_ms = load.ms();
  for (const std::string& warning : scene.warnings) console.warn(warning);
  stats.view = make_view(scene, options.view, console);
  light_up(scene, stats.view.camera, console);
  stats.scene_file = options.scene.filename().string();
  stats.scene = count_scene(scene);
  stats.object_count = scene.objects.size();
  stats.material_count = scene.materials.size();
  stats.light_count = scene.lights.size();
  console.detail(fmt::format("loaded {}: objects {}, primitives {}, {:.1f} ms", options.scene.string(),
                             scene.objects.size(), stats.scene.primitives, stats.load_ms));

  const gpu::DeviceHandle device = gpu::open_device(options.device);
  stats.device = gpu::info_of(*device);
  console.detail(gpu::choice_of(*device));
  const Image image = trace(*device, scene, options, stats, console);
  if (const uint64_t count = gpu::validation_message_count(*device); count > 0) {
    throw RunError({fmt::format("the Vulkan validation layers reported {} problems", count), stats.device.name,
                    "report them as a bug of promin"});
  }

  const DeferredSignals while_writing;
  const Stopwatch write;
  write_pictures(options.pictures, image, stats);
  stats.write_ms = write.ms();
  stats.total_ms = total.ms();
  if (options.stats) write_text_file(*options.stats, to_json(stats));
  if (!console.is_quiet()) fmt::print("{}\n", summarize(stats, options));
}

}  // namespace

Command add_render_command(CLI::App& program) {
  CLI::App& command = add_command(program, "render", "Render a picture of a scene");
  const auto options = std::make_shared<RenderOptions>();
  add_render_options(command, *options);
  return {&command, [options] { render(*options); }};
}

}  // namespace promin::app
