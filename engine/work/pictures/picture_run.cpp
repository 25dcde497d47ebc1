// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/picture_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "promin/error.h"
#include "promin/image.h"
#include "work/pictures/camera_choice.h"
#include "work/pictures/ground.h"
#include "work/pictures/load_posed.h"
#include "work/pictures/usual_integrator.h"
#include "work/pictures/view_setup.h"

namespace promin::work {
namespace {

void check_explained_pixel(const RenderSpec& options, const uvec2& size) {
  if (!options.explained_pixel || glm::all(glm::lessThan(*options.explained_pixel, size))) return;
  throw UsageError({"view.pixel.outside",
                    fmt::format("the pixel of --explain is outside the picture of {}x{} pixels", size.x, size.y), "",
                    "use a pixel inside the picture, or give a larger --size"});
}

/// The cameras of all frames.
std::vector<Camera> cameras_of(const PictureRun& run) {
  std::vector<Camera> cameras;
  for (const PlannedFrame& frame : run.frames) cameras.push_back(frame.camera.value_or(run.stats.view->camera));
  return cameras;
}

/// Sets the cameras of a turntable, which move once around the scene. `camera` is the camera of the first frame.
void turn_frames(std::vector<PlannedFrame>& frames, uint32_t count, const Scene& scene, const ViewOptions& view,
                 const Camera& camera) {
  for (PlannedFrame& frame : frames) {
    frame.camera = turn_around(scene, view, camera, *frame.number, count);
  }
}

/// Returns the scene of a film. Throws UsageError if the scene has no animations.
std::shared_ptr<MovingScene> make_moving(Scene scene, const RenderSpec& options) {
  MotionOptions motion = options.tracing.motion;
  if (!motion.time_s) motion.time_s = 0.0;
  PoseChoice clip = choose_pose(scene, motion);
  if (clip.animations.empty()) {
    throw UsageError(
        {"animation.missing", "the scene has no animation to show", scene.file.string(),
         options.moves_camera() ? "remove --animation" : "give --turntable N or --path to move the camera"});
  }
  return std::make_shared<MovingScene>(std::move(scene), std::move(clip));
}

/// Returns the integrator of all frames if the options name none. `moving` is null if the scene does not move.
Integrator usual_integrator_of(const Scene& scene, const MovingScene* moving, LightChoice light) {
  if (moving == nullptr || light == LightChoice::kSoft) return usual_integrator(scene, light);
  return moving->lights_itself() ? Integrator::kDirect : Integrator::kWhitted;
}

}  // namespace

PictureRun prepare_pictures(const RenderSpec& given, std::vector<PlannedFrame> frames, const Messages& console) {
  PictureRun run{.options = given, .frames = std::move(frames), .scene = {}, .sources = {}, .stats = {}};
  const RenderSpec& options = run.options;
  RunStats& stats = run.stats;
  stats.shutter = options.shutter;
  // A path without --fps has the times of its file. A turntable of a resting scene has no times.
  const bool has_fps =
      options.path ? options.fps.value_or(PathPictures::kStored) != PathPictures::kStored : options.moves_scene();
  if (options.shutter && has_fps) stats.shutter_fps = options.fps.value_or(kDefaultFps);
  std::shared_ptr<MovingScene> moving;
  if (options.moves_scene()) {
    TracingOptions resting = options.tracing;
    resting.motion = {};
    moving = make_moving(load_for(resting, stats, console, run.sources), options);
    stats.motion = options.tracing.motion;
    stats.motion.time_s = 0.0;
    if (run.frames.empty()) run.frames = plan_film(options, moving->duration_s());
    run.scene = moving->envelope();
  } else {
    run.scene = load_for(options.tracing, stats, console, run.sources);
  }
  Scene& scene = run.scene;
  move_frames(run.frames, scene.center);
  for (PlannedFrame& frame : run.frames) {
    if (frame.camera) put_lens(options.view, *frame.camera);
  }
  ViewOptions view = options.view;
  view.given_camera = run.frames.front().camera;
  view.shows_all_sides = options.turntable.has_value();
  stats.has_named_integrator = view.integrator.has_value();
  const Integrator integrator =
      view.integrator ? *view.integrator : usual_integrator_of(scene, moving.get(), view.look.light);
  run.options.view.integrator = integrator;
  apply_quality(run.options);
  view.samples_per_pixel = run.options.view.samples_per_pixel;
  ViewOptions complete = view;
  complete.integrator = integrator;
  stats.view = make_view(scene, complete, console);
  if (options.turntable) turn_frames(run.frames, *options.turntable, scene, view, stats.view->camera);
  stats.view->error_target = options.error.error_target();
  check_explained_pixel(options, stats.view->size);
  warn_of_empty_pictures(scene, cameras_of(run), stats.view->size, console);
  if (const std::string note = describe_file_camera(scene, view, *stats.view); !note.empty()) console.note(note);
  const EnvironmentChoice surroundings(view.environment);
  for (const std::string& warning : surroundings.warnings()) console.warn(warning);
  // Lamps that move are boxes in the scene of a film.
  std::optional<Scene> brightest;
  if (moving) surroundings.replace_sky(brightest.emplace(moving->brightest()));
  surroundings.replace_sky(scene);
  LookOptions look = view.look;
  settle_light(brightest ? *brightest : scene, integrator, look);
  brightest.reset();
  AssumedLight assumed = light_up(scene, look, surroundings, upward_direction(scene, view));
  if (options.aovs.alpha) assumed.has_background = false;  // With alpha, no picture shows a background.
  stats.display = choose_display(scene, look, view.debug_view);
  if (stats.view->error_target) fit_to_display(*stats.view->error_target, stats.display);
  // If errors are measured as displayed, the display also affects the bits of an EXR.
  const bool is_displayed = std::ranges::any_of(options.pictures, std::not_fn(has_named_channels)) ||
                            (stats.view->error_target && stats.view->error_target->display);
  const std::string assumptions = describe_assumptions(scene, view, assumed, integrator,
                                                       is_displayed ? std::optional(stats.display) : std::nullopt);
  if (!assumptions.empty()) console.note(assumptions);
  // The pieces of a job may be displayed later, so they keep this AOV.
  const bool keeps_unlit =
      (is_displayed || options.job.folder) && shows_unlit_apart(scene, scene.environment, view.look, stats.display);
  run.options.hides_unlit = keeps_unlit && !options.aovs.unlit;
  run.options.aovs.unlit |= keeps_unlit;
  check_lights(scene, options.view.lights_off);
  if (moving) {
    moving->take_light(scene, options.view.lights_off);
    run.moving = moving;
  }
  switch_lights(scene.lights, options.view.lights_off);
  refresh_ground(scene);
  const auto is_on = [](const Light& light) { return light.is_on; };
  stats.light_count = static_cast<size_t>(std::count_if(scene.lights.begin(), scene.lights.end(), is_on));
  return run;
}

uint64_t count_samples(const View& view, size_t frames, const RenderSpec& options) {
  if (options.explained_pixel) return view.samples_per_pixel;
  const uvec2 size = view.crop ? view.crop->hi - view.crop->lo : view.size;
  const uint32_t samples = view.error_target ? view.error_target->min_samples : view.samples_per_pixel;
  return uint64_t{size.x} * size.y * samples * frames * options.tracing.repeat_count;
}

TunedRendererOptions make_renderer_options(const RenderSpec& options, uint64_t expected_samples) {
  TunedRendererOptions result;
  result.expected_samples = expected_samples;
  choose_tree(options.tracing, result);
  result.texture_bytes = uint64_t{options.view.look.texture_memory_mib} << 20;
  if (options.has_all_features) result.more_features = all_features();
  // A run with a time limit begins with a picture of one sample per pixel.
  result.has_error_target = options.error.target && !options.error.time_limit_s;
  result.mode = {options.view.debug_view, !options.view.has_no_shadows,
                 options.view.integrator.value_or(Integrator::kWhitted)};
  result.has_lens = options.view.aperture_radius.value_or(0.0) > 0.0;
  result.aovs = options.aovs;
  // The average exposure only uses pixels with a hit, so it needs this AOV.
  if (options.view.look.averages_exposure) result.aovs.object = true;
  return result;
}

TracedFrame trace(Renderer& renderer, const View& view, const RenderSpec& options, const std::optional<double>& limit_s,
                  const std::function<bool(double)>& on_progress) {
  TracedFrame frame;
  const uint32_t repeats = options.tracing.repeat_count;
  for (uint32_t i = 0; i < repeats; ++i) {
    const auto tell = [&](double fraction) { return on_progress((i + fraction) / repeats); };
    frame.result = limit_s ? renderer.render_within(view, *limit_s, tell) : renderer.render(view, tell);
    frame.trace_ms.push_back(frame.result.trace_ms);
  }
  return frame;
}

Metadata make_metadata(const RunStats& stats, const std::optional<uint32_t>& frame, const AovHeader& aovs) {
  Metadata metadata = describe_picture(stats);
  if (frame) metadata.emplace_back("promin:frame", std::to_string(*frame));
  metadata.insert(metadata.end(), aovs.metadata.begin(), aovs.metadata.end());
  return metadata;
}

PixelWindow window_of(const View& view) {
  return view.crop.value_or(PixelWindow{uvec2(0), view.size});
}

}  // namespace promin::work
