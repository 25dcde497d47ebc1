// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/aovs.h"
#include "promin/scene.h"
#include "promin/view.h"
#include "work/pictures/picture_run.h"

namespace promin::work {

/// Returns the camera of the file in the pose of a frame; empty if the frame has its own camera, or if the camera does
/// not come from the file.
std::optional<Camera> file_camera_in(const Scene& posed, const PictureRun& run, const PlannedFrame& frame);

/// Computes Aovs::motion of the pictures of a run.
class FrameMotion {
 public:
  /// The run must outlive this object.
  explicit FrameMotion(const PictureRun& run) : run_(run) {}

  /// Sets Aovs::motion of a picture of a frame with this view. The picture shows the moment at this fraction of the
  /// time until the next frame. The movement is that from this moment to the same moment of the next frame. Does
  /// nothing if the run does not select this AOV.
  void add(const PlannedFrame& frame, double fraction, const View& view, Aovs& aovs);

 private:
  struct Posed {
    std::optional<double> time_s;
    Scene scene;
  };
  /// Returns the scene of a moment. `kept` has the scene of an earlier call.
  const Scene& scene_of(const PlannedFrame& moment, std::optional<Posed>& kept) const;

  const PictureRun& run_;
  std::optional<Posed> now_;
  std::optional<Posed> next_;
};

}  // namespace promin::work
