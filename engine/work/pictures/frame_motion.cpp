// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/frame_motion.h"

#include "promin/motion_vectors.h"
#include "work/pictures/camera_choice.h"
#include "work/pictures/shutter.h"
#include "work/pictures/view_setup.h"

namespace promin::work {

std::optional<Camera> file_camera_in(const Scene& posed, const PictureRun& run, const PlannedFrame& frame) {
  const ViewOptions& view = run.options.view;
  if (frame.camera || find_file_camera(posed, view) == nullptr) return std::nullopt;
  return make_view(posed, view, Messages()).camera;
}

const Scene& FrameMotion::scene_of(const PlannedFrame& moment, std::optional<Posed>& kept) const {
  if (run_.moving == nullptr) return run_.scene;
  if (!kept || kept->time_s != moment.time_s) {
    kept = Posed{moment.time_s, run_.moving->at(moment.time_s.value_or(0.0))};
  }
  return kept->scene;
}

void FrameMotion::add(const PlannedFrame& frame, double fraction, const View& view, Aovs& aovs) {
  if (!run_.options.aovs.motion) return;
  const PlannedFrame next = frame_between(run_, frame, fraction + 1.0);
  const Scene& scene = scene_of(frame_between(run_, frame, fraction), now_);
  const Scene& next_scene = scene_of(next, next_);
  Camera camera = view.camera;
  if (next.camera) {
    camera = *next.camera;
  } else if (const std::optional<Camera> posed = file_camera_in(next_scene, run_, next)) {
    camera = *posed;
  }
  add_motion(scene, view, next_scene, camera, aovs);
}

}  // namespace promin::work
