// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// The user's input to the viewer, except for flying.

#include <fmt/format.h>

#include <cstdio>

#include "output/outputs.h"
#include "promin/error.h"
#include "promin/framing.h"
#include "view/viewer.h"
#include "work/pictures/tracing_run.h"
#include "work/spec/check_spec.h"

namespace promin::app {

uvec2 Viewer::pixel_at(const dvec2& place) const {
  const dvec2 full_size(traced_->picture().full_size());
  const dvec2 pixel = place * full_size / glm::max(dvec2(window_.framebuffer_size()), 1.0);
  return uvec2(glm::clamp(pixel, dvec2(0.0), full_size - 1.0));
}

void Viewer::handle_input() {
  for (const Press press : window_.take_presses()) handle_press(press);
  for (const std::string& file : window_.take_dropped()) open(file);
  if (const std::optional<std::string> file = dialog_.take()) take_file(dialog_.use(), *file);
  // No pixel is traced while the environment is copied to the devices.
  if (!putting_.is_busy()) handle_clicks();
  if (traced_ && std::exchange(wants_command_, false)) print_command();
  if (window_.take_activity()) draw_again();
}

void Viewer::handle_clicks() {
  const std::vector<dvec2> clicks = window_.take_clicks();
  const std::vector<dvec2> double_clicks = window_.take_double_clicks();
  if (traced_) {
    View view = current_view();
    view.error_target.reset();
    for (const dvec2& place : clicks) query_.ask_why(scene_, view, pixel_at(place));
    for (const dvec2& place : double_clicks) look_at(view, pixel_at(place));
  }
}

void Viewer::look_at(const View& view, const uvec2& pixel) {
  wants_orbit_ = true;
  is_of_middle_ = false;
  query_.ask_point(scene_, view, pixel);
}

void Viewer::open(const std::filesystem::path& file) {
  if (opening_.is_busy()) return report_failure("another scene is still being opened");
  file_ = file;
  window_.set_title(title_of(file_));
  opening_.start([this, file] { return start_.open(file); });
  draw_again();
}

void Viewer::ask_for_file(FileUse use) {
  const bool is_open = use == FileUse::kOpen;
  const std::string name = is_open ? (file_.parent_path() / "").string() : file_.stem().string() + ".png";
  if (dialog_.ask(use, name)) return;
  path_entry_.emplace(PathEntry{.use = use});
  name.copy(path_entry_->text.data(), path_entry_->text.size() - 1);
  draw_again();
}

void Viewer::take_file(FileUse use, const std::filesystem::path& file) {
  path_entry_.reset();
  if (use == FileUse::kOpen) return open(file);
  save(file);
}

void Viewer::save(std::filesystem::path file) {
  if (!file.has_extension()) file += ".png";
  try {
    check_pictures({file});
    check_overwrites(files_of(opened_.sources), {file}, std::nullopt);
  } catch (const Error& error) {
    return report_failure(error.what());
  }
  saved_file_ = file;
  wants_screenshot_ = true;
}

void Viewer::frame_from(std::optional<Framing> from) {
  if (!opened_.scene || framing_.is_busy()) return;
  const dvec2 size(glm::max(swapchain_.size(), uvec2(1)));
  const auto aspect_ratio = static_cast<float>(size.x / size.y);
  // Framing takes some time, because it reads every vertex.
  framing_.start(
      [scene = scene_ ? scene_->scene : opened_.scene, camera = control_.camera(), up = start_.up, from, aspect_ratio] {
        return from ? frame_scene(*scene, aspect_ratio, {.from = from, .up = up})
                    : fit_camera(*scene, camera, aspect_ratio);
      });
}

void Viewer::show_camera(int step) {
  if (!opened_.scene || opened_.scene->cameras.empty()) return;
  const std::vector<Camera>& cameras = opened_.scene->cameras;
  const auto count = static_cast<int>(cameras.size());
  camera_index_ = (camera_index_ + step + count) % count;
  control_.place(cameras[static_cast<size_t>(camera_index_)]);
}

void Viewer::handle_press(Press press) {
  switch (press) {
    case Press::kHelp:
      has_help_ = !has_help_;
      return;
    case Press::kOverlay:
      has_overlay_ = !has_overlay_;
      return;
    case Press::kFullscreen:
      return window_.toggle_fullscreen();
    case Press::kReset:
      return control_.reset();
    case Press::kPause:
      switches_.is_paused = !switches_.is_paused;
      return;
    case Press::kOrbit:
      if (putting_.is_busy()) return;
      wants_orbit_ = !wants_orbit_ && !control_.is_orbiting() && traced_;
      is_of_middle_ = true;
      if (wants_orbit_) return query_.ask_point(scene_, view_of_middle(), uvec2(0));
      return control_.fly();
    case Press::kFrame:
      return frame_from(std::nullopt);
    case Press::kFront:
      return frame_from(Framing::kFront);
    case Press::kRight:
      return frame_from(Framing::kRight);
    case Press::kTop:
      return frame_from(Framing::kTop);
    case Press::kNextCamera:
      return show_camera(1);
    case Press::kPreviousCamera:
      return show_camera(-1);
    case Press::kPlay:
    case Press::kStepBack:
    case Press::kStepAhead:
    case Press::kSlower:
    case Press::kFaster:
    case Press::kNextAnimation:
      return move_clock(press);
    case Press::kBookmark:
      bookmarks_.push_back(control_.camera());
      bookmarks_.back().name = fmt::format("bookmark {}", bookmarks_.size());
      return;
    case Press::kPrintCommand:
      wants_command_ = true;
      return;
    case Press::kScreenshot:
      saved_file_.reset();
      wants_screenshot_ = true;
      return;
    case Press::kQuit:
      is_quitting_ = true;
      return;
    default:
      break;
  }
  switches_.debug_view = static_cast<DebugView>(static_cast<int>(press) - static_cast<int>(Press::kFirstDebugView));
}

void Viewer::move_clock(Press press) {
  if (!opened_.scene) return;
  if (clock_.clips().empty()) return report_failure("the scene has no animation");
  if (replay_) return report_failure("an animation does not play during the replay of a flight");
  constexpr double kFactor = 2.0;
  if (press == Press::kPlay) clock_.toggle();
  if (press == Press::kStepBack) clock_.step(-1);
  if (press == Press::kStepAhead) clock_.step(1);
  if (press == Press::kSlower) clock_.set_speed(clock_.speed() / kFactor);
  if (press == Press::kFaster) clock_.set_speed(clock_.speed() * kFactor);
  if (press == Press::kNextAnimation) clock_.choose_next();
  draw_again();
}

View Viewer::view_of_middle() const {
  // A picture of one pixel has one sample, which goes through the middle.
  View view;
  view.camera = control_.camera();
  view.size = uvec2(1);
  return view;
}

void Viewer::print_command() {
  const View view = reproducible_view();
  if (!can_describe(described_scene(view), view)) {
    return report_failure(
        fmt::format("no command of promin render renders this view, because no option sets the half height {:g} of an "
                    "orthographic camera, "
                    "and no camera of the scene has it; record the flight and use promin render --path",
                    view.camera.ymag));
  }
  fmt::print("{}\n", describe_command(described_scene(view), view));
  std::fflush(stdout);
}

DescribedScene Viewer::described_scene(const View& view) const {
  const SceneChoice& on = scene_->choice;
  LookOptions look = start_.look;
  look.light = scene_->light;
  // The automatic exposure is that of the pose in which the scene was opened.
  const bool has_other_pose = scene_->motion != opened_.motion;
  const Surroundings& surroundings = scene_->surroundings;
  if (surroundings.background) look.background = BackgroundChoice{.color = *surroundings.background};
  if (look.averages_exposure || switches_.exposure_ev || has_other_pose) look.exposure_ev = display().exposure_ev;
  DescribedScene described;
  described.file = file_;
  described.has_shadows = mode_.has_shadows;
  described.lights_off = on.lights_off;
  described.look = look;
  described.usual_integrator = opened_.usual_integrator;
  described.environment = start_.environment;
  described.environment.light_rotation_deg = surroundings.light_rotation_deg;
  described.variant = opened_.load.material_variant;
  described.root = opened_.load.root;
  described.motion = scene_->motion;
  described.center = scene_->scene->center;
  described.camera_index = find_half_height(*scene_->scene, view.camera);
  described.instances = on.instances;
  described.builder = on.builder;
  described.bvh = on.bvh;
  return described;
}

}  // namespace promin::app
