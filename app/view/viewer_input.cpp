// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// What the user does, apart from flying.

#include <fmt/format.h>

#include <cstdio>

#include "view/viewer.h"

namespace promin::app {

void Viewer::handle_input() {
  window_.set_overlay_wants(imgui_->wants_keys(), imgui_->wants_pointer());
  for (const Press press : window_.take_presses()) handle_press(press);
  for (const dvec2& place : window_.take_clicks()) {
    const dvec2 full_size(picture_->full_size());
    const dvec2 pixel = place * full_size / glm::max(dvec2(window_.framebuffer_size()), 1.0);
    View view = current_view();
    view.error_target.reset();
    query_.ask_why(scene_, view, uvec2(glm::clamp(pixel, dvec2(0.0), full_size - 1.0)));
  }
  if (const double steps = window_.take_wheel(); steps != 0.0) control_.change_speed(steps);
  if (window_.take_activity()) draw_again();
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
      wants_orbit_ = !wants_orbit_ && !control_.is_orbiting();
      if (wants_orbit_) return query_.ask_middle(scene_, control_.camera());
      return control_.fly();
    case Press::kBookmark:
      bookmarks_.push_back(control_.camera());
      bookmarks_.back().name = fmt::format("bookmark {}", bookmarks_.size());
      return;
    case Press::kPrintCommand: {
      const View view = reproducible_view();
      if (!can_describe(described_scene(view), view)) {
        return report_failure(
            fmt::format("no command of promin render gives this view: no option takes the half height "
                        "{:g} of an orthographic camera, and the scene has none such; give the "
                        "flight to promin render --path",
                        view.camera.ymag));
      }
      fmt::print("{}\n", describe_command(described_scene(view), view));
      std::fflush(stdout);
      return;
    }
    case Press::kScreenshot:
      wants_screenshot_ = true;
      return;
    case Press::kQuit:
      is_quitting_ = true;
      return;
    default:
      break;
  }
  if (press >= Press::kFirstDebugView) {
    switches_.debug_view = static_cast<DebugView>(static_cast<int>(press) - static_cast<int>(Press::kFirstDebugView));
    return;
  }
  const auto index = static_cast<size_t>(press) - static_cast<size_t>(Press::kFirstCamera);
  const std::vector<Camera>& cameras = scene_->scene->cameras;
  if (index < cameras.size()) control_.place(cameras[index]);
}

DescribedScene Viewer::described_scene(const View& view) const {
  const SceneChoice& on = scene_->choice;
  LookOptions look = start_.look;
  if (look.averages_exposure) look.exposure_ev = scene_->display.exposure_ev;
  DescribedScene described;
  described.file = start_.file;
  described.has_shadows = mode_.has_shadows;
  described.lights_off = on.lights_off;
  described.look = look;
  described.environment = start_.environment;
  described.variant = start_.variant;
  described.root = start_.root;
  described.center = scene_->scene->center;
  described.camera_index = find_half_height(*scene_->scene, view.camera);
  described.builder = on.builder;
  described.bvh = on.bvh;
  return described;
}

}  // namespace promin::app
