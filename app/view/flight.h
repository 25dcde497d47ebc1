// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "camera_path.h"
#include "view/frame_queue.h"

namespace promin::app {

/// Keeps a flight of the camera for a file.
class FlightRecorder {
 public:
  /// The camera of a frame at a time in seconds; the first frame is at 0. A camera that stands still is kept where it
  /// begins and ends to.
  void add(double time_s, const Camera& camera);
  const CameraPath& path() const { return path_; }

 private:
  double start_s_ = 0.0;
  CameraPath path_;
};

/// Plays a flight frame by frame, however long each takes, and measures that.
class FlightReplay {
 public:
  explicit FlightReplay(CameraPath path) : path_(std::move(path)) {}

  /// The camera of the next frame; not when done.
  const Camera& next_camera() { return path_[next_++].camera; }
  bool is_done() const { return next_ == path_.size(); }

  void add(const FinishedFrame& frame);
  /// One line: how many frames, the median and the 99th percentile of their times, and what of it was tracing.
  std::string summarize() const;

 private:
  CameraPath path_;
  size_t next_ = 0;
  std::vector<double> frame_ms_;
  double total_ms_ = 0.0;
  double trace_ms_ = 0.0;
};

}  // namespace promin::app
