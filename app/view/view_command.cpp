// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/view_command.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <memory>

#include "camera_choice.h"
#include "camera_path.h"
#include "load_options.h"
#include "outputs.h"
#include "promin/error.h"
#include "render_options.h"
#include "run_program.h"
#include "tracing_run.h"
#include "view/viewer.h"
#include "view_setup.h"

namespace promin::app {
namespace {

/// Drivers of GPUs kill what takes seconds.
constexpr double kMinTargetMs = 1.0;
constexpr double kMaxTargetMs = 1000.0;
constexpr double kMinScale = 0.01;

struct WindowOptions {
  TracingOptions tracing;
  ViewOptions view;
  ErrorOptions error;
  std::optional<std::string> present_mode;
  std::optional<double> target_ms;
  std::optional<double> scale;
  std::optional<std::filesystem::path> record;
  std::optional<std::filesystem::path> replay;
  std::optional<double> fps;
  bool stays_open = false;
};

void add_window_options(CLI::App& program, WindowOptions& options) {
  OptionTable table(program);
  add_scene_argument(table, options.tracing);
  add_variant_option(table, options.tracing.load);
  add_view_options(table, options.view);
  add_error_options(table, options.error,
                    fmt::format("A picture at rest takes samples until each pixel is off by at most E, {} to 1, "
                                "where 1 is white [{:g}]",
                                least_error(), ErrorTarget{}.error));
  table.add("--target-ms", "T",
            fmt::format("Time of a frame to keep to while moving, {} to {} [a GPU: the display's; a CPU device: {}]",
                        kMinTargetMs, kMaxTargetMs, ViewerStart::kCpuTargetMs),
            [&](const OptionValues& w) { options.target_ms = w.real(0, kMinTargetMs, kMaxTargetMs); });
  table.add("--scale", "S",
            fmt::format("Pixels of a moving picture for one of the window on a side, {} to 1 [as the target allows]",
                        kMinScale),
            [&](const OptionValues& w) { options.scale = w.real(0, kMinScale, 1.0); });
  table.add("--present-mode", "MODE",
            fmt::format("How frames go to the display: {}; fifo where it has no other [fifo]",
                        fmt::join(present_mode_names(), ", ")),
            [&](const OptionValues& w) { options.present_mode = w.choice(present_mode_names()); });
  table.add("--record", "FILE.json", "Write the camera's flight, a camera path, when the window closes",
            [&](const OptionValues& w) { options.record = w.text(); });
  table.add("--replay", "FILE.json", "Play a camera path, print what its frames took, and close",
            [&](const OptionValues& w) { options.replay = w.text(); });
  add_fps_option(table, options.fps);
  table.add_flag("--keep-open", "After --replay let the user fly on", options.stays_open);
  add_tracing_options(table, options.tracing);
}

void check_window_options(const WindowOptions& options) {
  check_tracing_options(options.tracing);
  check_pose_options(options.view.pose, options.view.camera.has_value());
  if (options.replay) check_no_camera(options.view, "--replay");
  if (options.stays_open && !options.replay) {
    throw UsageError({"--keep-open has no replay to end", "on the command line", "give --replay as well"});
  }
  if (options.fps && !options.replay) {
    throw UsageError({"--fps has no path to play", "on the command line", "give --replay as well"});
  }
  check_error_target(options.error.target_or(ErrorTarget{}.error));
  std::vector<std::filesystem::path> inputs = input_files(options.tracing);
  if (options.replay) inputs.push_back(*options.replay);
  if (options.view.environment.panorama) inputs.push_back(*options.view.environment.panorama);
  if (options.record) check_outputs(inputs, {*options.record}, std::nullopt);
}

/// Waits for the picture while the window answers; nullopt where the user closes the window.
std::optional<ReadyPicture> await_first_picture(Window& window, const std::string& title, ScenePreparer& preparer) {
  constexpr double kWait = 0.02;
  while (!preparer.is_ready()) {
    window.set_title(title + " (" + preparer.describe() + ")");
    window.wait(kWait);
    if (window.wants_to_close()) return std::nullopt;
  }
  window.set_title(title);
  return preparer.take();
}

void view(const WindowOptions& options) {
  const TracingOptions& tracing = options.tracing;
  check_window_options(options);
  const Console console(tracing.verbosity(), "promin-view");

  RunStats stats;
  std::vector<SourceFile> sources;
  ViewerStart start;
  start.file = tracing.scene;
  auto scene = std::make_shared<Scene>(load_for(tracing, stats, console, sources));
  const EnvironmentChoice environment(options.view.environment);
  for (const std::string& warning : environment.warnings()) console.warn(warning);
  ViewOptions view_options = options.view;
  if (options.replay) {
    start.replay.emplace(PathPictures(read_camera_path(*options.replay), options.fps).moved_to(scene->center));
    view_options.given_camera = start.replay->camera(0);
  }
  start.view = make_view(*scene, view_options, console);
  if (!options.replay) warn_of_empty_pictures(*scene, {&start.view.camera, 1}, start.view.size, console);
  const LookOptions& look = options.view.look;
  const AssumedLight assumed = light_up(*scene, look, environment);
  const DisplayTransform display = choose_display(*scene, look, start.view.mode.debug_view);
  const std::string assumptions = describe_assumptions(*scene, view_options, assumed, display);
  if (!assumptions.empty()) console.note(assumptions);
  start.look = look;
  start.environment = options.view.environment;
  start.variant = tracing.load.material_variant;
  start.root = tracing.load.root;
  start.error_target = options.error.target_or(ErrorTarget{}.error);
  start.choice.builder = tracing.builder.value_or(RendererOptions{}.builder);
  start.choice.bvh = tracing.bvh;
  check_lights(*scene, options.view.lights_off);
  start.choice.lights_off = options.view.lights_off;
  start.present_mode = options.present_mode;
  start.target_ms = options.target_ms;
  start.scale = options.scale;
  start.stays_open = options.stays_open;
  start.record = options.record;

  const std::string title = "promin - " + start.file.filename().string();
  Window window(start.view.size, title);
  const gpu::Presentation presentation = window.presentation();
  const gpu::Device device({.selection = tracing.device, .presentation = &presentation});
  stats.device = device.info();
  console.detail(device.choice());
  ScenePreparer preparer(device, start.target_ms.value_or(ViewerStart::kCpuTargetMs), start.file, tracing.load,
                         std::move(sources), look, environment, start.view);
  // This takes longest and comes last, because without a window it would be in vain.
  preparer.begin(scene, {start.choice, start.view.mode, window.framebuffer_size()});
  std::optional<ReadyPicture> picture = await_first_picture(window, title, preparer);
  if (!picture) return;
  for (const Problem& warning : picture->scene->renderer->setup_stats().warnings) console.warn(message_of(warning));
  gpu::translate_vulkan_errors(
      [&] { Viewer(window, device, console, preparer, std::move(*picture), std::move(start), stats).run(); });
  check_validation(device, stats);
}

}  // namespace

Command add_view_command(CLI::App& program) {
  const auto options = std::make_shared<WindowOptions>();
  add_window_options(program, *options);
  return {&program, [options] { view(*options); }};
}

}  // namespace promin::app
