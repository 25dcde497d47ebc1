// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "camera_path.h"
#include "view/finished_frame.h"

namespace promin::app {

/// Records a flight of the camera for a file.
class FlightRecorder {
 public:
  /// Adds the camera at a time in seconds; the first is at 0. Between two calls the camera is taken to move evenly, so
  /// a call belongs to each frame and to the end of each rest. Of a rest the beginning and the end are kept.
  /// `center` is of the scene (Scene::center).
  void add(double time_s, const Camera& camera, const dvec3& center = dvec3(0.0));
  const CameraPath& path() const { return path_; }

  /// The rate that a recorded flight is meant to be played with, in pictures a second.
  static constexpr double kFps = 30.0;

 private:
  double start_s_ = 0.0;
  CameraPath path_{{}, kFps};
};

/// Plays a flight picture by picture, without leaving any out, however long each takes, and measures their times.
class FlightReplay {
 public:
  explicit FlightReplay(PathPictures pictures) : pictures_(std::move(pictures)) {}

  /// Whether it is time for the next picture: none comes earlier than its interval after the one before. Never when
  /// done. Times are in seconds.
  bool is_due(double time_s) const { return !is_done() && time_s >= due_s_; }
  /// The next picture's camera. Must not be called when done.
  Camera next_camera(double time_s);
  bool is_done() const { return next_ == pictures_.count(); }

  void add(const FinishedFrame& frame);
  /// One line: how many frames, the median and the 99th percentile of their times, what of it was tracing, and the rate
  /// of camera rays, which is that of pixels where each has one sample.
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
