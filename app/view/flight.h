// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "view/display/finished_frame.h"
#include "work/pictures/camera_path.h"

namespace promin::app {

/// Records the flight of a camera for a file.
class FlightRecorder {
 public:
  /// Adds the camera at a time in seconds; the first is at 0. The camera is assumed to move evenly between two calls.
  /// The function must therefore be called for each frame and at the end of each rest. Only the beginning and the end
  /// of a rest are stored. `center` is Scene::center.
  void add(double time_s, const Camera& camera, const dvec3& center = dvec3(0.0));
  const CameraPath& path() const { return path_; }

  /// The playback rate of a recorded flight, in pictures per second.
  static constexpr double kFps = 30.0;

 private:
  double start_s_ = 0.0;
  CameraPath path_{{}, kFps};
};

/// Plays a flight picture by picture and measures the time of each picture. It skips no picture, however long a picture
/// takes.
class FlightReplay {
 public:
  explicit FlightReplay(PathPictures pictures) : pictures_(std::move(pictures)) {}

  /// Returns whether the next picture is due. It is due when its interval after the previous picture has passed, and
  /// never when all pictures are shown. Times are in seconds.
  bool is_due(double time_s) const { return !is_done() && time_s >= due_s_; }
  /// Returns the next picture's camera. Must not be called after the last picture.
  Camera next_camera(double time_s);
  bool is_done() const { return next_ == pictures_.count(); }

  void add(const FinishedFrame& frame);
  /// Returns a line with the number of frames, the median and the 99th percentile of their times, the fraction of
  /// tracing, and the rate of camera rays. With one sample per pixel this is the rate of pixels.
  std::string summarize() const;

 private:
  PathPictures pictures_;
  size_t next_ = 0;
  double due_s_ = 0.0;
  std::vector<double> frame_ms_;
  double total_ms_ = 0.0;
  double trace_ms_ = 0.0;
  uint64_t camera_ray_count_ = 0;
};

}  // namespace promin::app
