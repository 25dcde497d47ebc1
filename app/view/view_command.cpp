// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/view_command.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "options/load_options.h"
#include "options/render_options.h"
#include "options/tracing_options.h"
#include "output/outputs.h"
#include "output/run_program.h"
#include "promin/error.h"
#include "view/viewer.h"
#include "work/pictures/camera_choice.h"
#include "work/pictures/camera_path.h"
#include "work/pictures/tracing_run.h"
#include "work/pictures/usual_integrator.h"
#include "work/pictures/view_setup.h"
#include "work/spec/check_spec.h"

namespace promin::app {
namespace {

/// The smallest target time in milliseconds.
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
                    fmt::format("While the view does not change, add samples until the estimated error of each pixel "
                                "is at most E, {} to 1. White is 1 [{:g}]",
                                least_error(), ErrorTarget{}.error));
  table.add("--target-ms", "T",
            fmt::format("Target time of a frame in milliseconds while the view moves, {} to {} [on a GPU the display's "
                        "refresh interval, on a CPU device {}]",
                        kMinTargetMs, kMaxTargetMs, ViewerStart::kCpuTargetMs),
            [&](const OptionValues& w) { options.target_ms = w.real(0, kMinTargetMs, kMaxTargetMs); });
  table.add("--scale", "S",
            fmt::format("Ratio of a moving picture's sides to those of the window, {} to 1 [chosen for --target-ms]",
                        kMinScale),
            [&](const OptionValues& w) { options.scale = w.real(0, kMinScale, 1.0); });
  table.add("--present-mode", "MODE",
            fmt::format("Vulkan present mode: {}. fifo is used if the display does not support the mode [fifo]",
                        fmt::join(present_mode_names(), ", ")),
            [&](const OptionValues& w) { options.present_mode = w.choice(present_mode_names()); });
  table.add("--record", "FILE.json", "Write the camera's flight as a camera path when the window closes",
            [&](const OptionValues& w) { options.record = w.text(); });
  table.add("--replay", "FILE.json", "Play a camera path, print the times of its frames, and close the window",
            [&](const OptionValues& w) { options.replay = w.text(); });
  add_fps_option(table, options.fps);
  table.add_flag("--keep-open", "Keep the window open after --replay", options.stays_open);
  add_tracing_options(table, options.tracing);
}

void check_window_options(const WindowOptions& options) {
  static_cast<void>(verbosity_of(options.tracing));
  check_tracing_options(options.tracing);
  check_pose_options(options.view.pose, options.view.camera.has_value());
  if (options.replay) check_no_camera(options.view, "--replay");
  if (options.stays_open && !options.replay) {
    throw UsageError({"usage.option.needs", "--keep-open needs a flight to replay", "", "give --replay as well"});
  }
  if (options.fps && !options.replay) {
    throw UsageError({"usage.option.needs", "--fps needs a camera path to replay", "", "give --replay as well"});
  }
  check_error_target(options.error.target_or(ErrorTarget{}.error));
  std::vector<std::filesystem::path> inputs = input_files(options.tracing);
  if (options.replay) inputs.push_back(*options.replay);
  if (options.view.environment.panorama) inputs.push_back(*options.view.environment.panorama);
  if (options.record) check_outputs(inputs, {*options.record}, std::nullopt);
}

OpenedScene open_scene(const WindowOptions& options, const Console& console) {
  OpenedScene opened;
  opened.file = options.tracing.scene;
  opened.load = options.tracing.load;
  opened.motion = options.tracing.motion;
  auto scene = std::make_shared<Scene>(load_for(options.tracing, opened.stats, console, opened.sources));
  // The window rotates the light itself.
  EnvironmentOptions environment = options.view.environment;
  environment.light_rotation_deg = 0.0;
  opened.environment = EnvironmentChoice(environment);
  for (const std::string& warning : opened.environment.warnings()) console.warn(warning);
  ViewOptions view_options = options.view;
  if (options.replay) {
    opened.replay.emplace(PathPictures(read_camera_path(*options.replay), options.fps).moved_to(scene->center));
    view_options.given_camera = opened.replay->camera(0);
  }
  opened.view = make_view(*scene, view_options, console);
  opened.usual_integrator =
      view_options.integrator ? usual_integrator(*scene, view_options.look.light) : opened.view.mode.integrator;
  if (!options.replay) warn_of_empty_pictures(*scene, {&opened.view.camera, 1}, opened.view.size, console);
  opened.look = options.view.look;
  opened.environment.replace_sky(*scene);
  settle_light(*scene, opened.view.mode.integrator, opened.look);
  const AssumedLight assumed =
      light_up(*scene, opened.look, opened.environment, upward_direction(*scene, view_options));
  const DisplayTransform display = choose_display(*scene, opened.look, opened.view.mode.debug_view);
  const std::string assumptions =
      describe_assumptions(*scene, view_options, assumed, opened.view.mode.integrator, display);
  if (!assumptions.empty()) console.note(assumptions);
  check_lights(*scene, options.view.lights_off);
  opened.bounds = bounds_of(*scene);
  opened.scene = std::move(scene);
  return opened;
}

/// Returns the options for a file other than that of the command line. Options that name parts of that file are
/// dropped.
WindowOptions options_for(WindowOptions options, const std::filesystem::path& file) {
  if (file == options.tracing.scene) return options;
  options.tracing.scene = file;
  options.tracing.load.material_variant.clear();
  options.tracing.load.root.clear();
  options.tracing.motion = {};
  options.view.camera.reset();
  options.view.pose = {};
  options.view.lights_off.clear();
  options.replay.reset();
  options.fps.reset();
  return options;
}

ViewerStart make_start(const WindowOptions& options, const Console& console) {
  const TracingOptions& tracing = options.tracing;
  ViewerStart start;
  start.file = tracing.scene;
  start.open = [&options, &console](const std::filesystem::path& file) {
    WindowOptions opened = options_for(options, file);
    // The number of threads was already set.
    opened.tracing.threads.reset();
    return open_scene(opened, console);
  };
  start.look = options.view.look;
  if (options.view.pose.up) start.up = vec3(*options.view.pose.up);
  start.environment = options.view.environment;
  start.error_target = options.error.target_or(ErrorTarget{}.error);
  start.choice.builder = tracing.builder.value_or(RendererOptions{}.builder);
  start.choice.bvh = tracing.bvh;
  start.choice.instances = tracing.instances;
  start.choice.lights_off = options.view.lights_off;
  start.present_mode = options.present_mode;
  start.target_ms = options.target_ms;
  start.scale = options.scale;
  start.stays_open = options.stays_open;
  start.record = options.record;
  return start;
}

/// Returns the size of the window before the scene is read. The scene may require another size.
uvec2 first_size(const ViewOptions& options) {
  Camera camera;
  const uvec2 usual = *default_size(camera);
  if (!options.size) return usual;
  return {options.size->x > 0 ? options.size->x : usual.x, options.size->y > 0 ? options.size->y : usual.y};
}

/// Opens the device that draws to the window. The window handles events meanwhile.
std::shared_ptr<const gpu::Device> open_device(Window& window, const TracingOptions& tracing) {
  constexpr double kWait = 0.005;
  const gpu::Presentation presentation = window.presentation();
  gpu::DeviceOptions options{.selection = tracing.device, .presentation = &presentation};
  if (tracing.has_no_cache) options.kernel_folder.reset();
  Background<std::shared_ptr<const gpu::Device>> opening;
  opening.start([&] { return std::make_shared<const gpu::Device>(options); });
  while (!opening.is_ready()) window.wait(kWait);
  return *opening.take();
}

void view(const WindowOptions& options) {
  check_window_options(options);
  choose_threads(options.tracing);
  const Console console(verbosity_of(options.tracing), "promin-view");
  ViewerStart start = make_start(options, console);
  Background<OpenedScene> opening;
  opening.start([&start, file = start.file] { return start.open(file); });
  std::unique_ptr<Window> window;
  std::shared_ptr<const gpu::Device> device;
  try {
    window = std::make_unique<Window>(first_size(options.view), title_of(start.file));
    device = open_device(*window, options.tracing);
  } catch (const Error&) {
    // Waits for the scene, so that its problems are reported first.
    opening.wait();
    static_cast<void>(opening.take());
    throw;
  }
  console.detail(device->choice());
  gpu::translate_vulkan_errors([&] {
    Viewer viewer(*window, device, console, std::move(start), std::move(opening));
    viewer.run();
    // A driver cannot cancel a compilation, and the program does not wait for it. On a busy machine, the driver's
    // threads of low priority take some time to end, and the process would end with them.
    if (viewer.is_busy()) {
      window->hide();
      std::fflush(nullptr);
      std::_Exit(0);
    }
    check_validation(*device, viewer.stats());
  });
}

}  // namespace

Command add_view_command(CLI::App& program) {
  const auto options = std::make_shared<WindowOptions>();
  add_window_options(program, *options);
  return {&program, [options] { view(*options); }};
}

}  // namespace promin::app
