// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render_command.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <bit>
#include <memory>

#include "console.h"
#include "core/error.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "deferred_signals.h"
#include "image/image.h"
#include "outputs.h"
#include "progress.h"
#include "render_options.h"
#include "tracing_run.h"
#include "view_setup.h"

namespace promin::app {
namespace {

/// Sets the renderer up, traces as often as asked for and leaves what it took in `stats`.
RenderResult trace(const gpu::Device& device, const Scene& scene, const RenderOptions& options, RunStats& stats,
                   const Console& console) {
  RendererOptions renderer_options;
  choose_tree(options.tracing, renderer_options);
  renderer_options.force_all_features = options.has_all_features;
  renderer_options.with_aovs = options.aovs.any();
  Renderer renderer(device, scene, renderer_options);
  take_setup(renderer.setup_stats(), stats, console);

  RenderResult result;
  Progress progress(console.is_quiet());
  const uint32_t repeats = options.tracing.repeat_count;
  for (uint32_t i = 0; i < repeats; ++i) {
    result = renderer.render(*stats.view, [&](double fraction) { progress.update((i + fraction) / repeats); });
    stats.trace_ms.push_back(result.trace_ms);
  }
  stats.rays = result.rays;
  return result;
}

Channel channel_of(const std::string& name, std::span<const float> values) {
  Channel channel{name, false, std::vector<uint32_t>(values.size())};
  std::transform(values.begin(), values.end(), channel.values.begin(),
                 [](float value) { return std::bit_cast<uint32_t>(value); });
  return channel;
}

std::vector<Channel> make_channels(const Aovs& aovs, const AovChoice& choice) {
  std::vector<Channel> channels;
  if (choice.depth) channels.push_back(channel_of("Z", aovs.depth));
  for (int axis = 0; choice.normal && axis < 3; ++axis) {
    std::vector<float> component;
    for (const vec3& normal : aovs.normal) component.push_back(normal[axis]);
    channels.push_back(channel_of(std::array{"N.X", "N.Y", "N.Z"}[static_cast<size_t>(axis)], component));
  }
  if (choice.object) channels.push_back({"object", true, aovs.object});
  if (choice.primitive) channels.push_back({"primitive", true, aovs.primitive});
  return channels;
}

Metadata make_metadata(const RunStats& stats) {
  return {{"promin:version", PROMIN_VERSION},
          {"promin:scene", stats.scene_file},
          {"promin:device", stats.device.name},
          {"promin:driver", stats.device.driver},
          {"promin:size", fmt::format("{}x{}", stats.view->size.x, stats.view->size.y)},
          {"promin:spp", std::to_string(stats.view->samples_per_pixel)},
          {"promin:max_depth", std::to_string(stats.view->max_depth)},
          {"promin:trace_ms", fmt::format("{:.3f}", stats.median_trace_ms())}};
}

void write_pictures(const RenderOptions& options, const RenderResult& result, const RunStats& stats) {
  std::optional<CropPlacement> placement;
  if (stats.view->crop) placement = CropPlacement{stats.view->crop->lo, stats.view->size};
  const Metadata metadata = make_metadata(stats);
  const std::vector<Channel> channels = make_channels(result.aovs, options.aovs);
  for (const std::filesystem::path& file : options.pictures) {
    write_image(file, result.image, metadata, placement, channels);
  }
}

std::string summarize(const RunStats& stats, const RenderOptions& options) {
  std::vector<std::string> files;
  for (const std::filesystem::path& file : options.pictures) files.push_back(file.string());
  return fmt::format("{}x{}, {} spp, {:.4g} Mrays in {:.1f} ms ({:.3g} Mrays/s) on {}: {}", stats.view->size.x,
                     stats.view->size.y, stats.view->samples_per_pixel, 1e-6 * static_cast<double>(stats.rays.total()),
                     stats.median_trace_ms(), stats.mrays_per_s(), stats.device.name, fmt::join(files, ", "));
}

void render(const RenderOptions& options) {
  const Stopwatch total;
  const TracingOptions& tracing = options.tracing;
  check_render_options(options);
  check_pictures(options.pictures);
  check_outputs(input_files(tracing), options.pictures, tracing.stats);
  const Console console(tracing.verbosity());

  RunStats stats;
  Scene scene = load_for(tracing, stats, console);
  stats.view = make_view(scene, options.view, console);
  light_up(scene, stats.view->camera, console);
  stats.light_count = scene.lights.size();

  const gpu::DeviceHandle device = open_device_for(tracing, stats, console);
  const RenderResult result = trace(*device, scene, options, stats, console);
  check_validation(*device, stats);

  const DeferredSignals while_writing;
  const Stopwatch write;
  write_pictures(options, result, stats);
  stats.write_ms = write.ms();
  stats.total_ms = total.ms();
  if (tracing.stats) write_text_file(*tracing.stats, to_json(stats));
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
