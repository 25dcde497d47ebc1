// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/flight.h"

#include <fmt/format.h>

#include "output/work_names.h"
#include "work/pictures/camera.h"
#include "work/pictures/quantiles.h"

namespace promin::app {

void FlightRecorder::add(double time_s, const Camera& camera, const dvec3& center) {
  std::vector<TimedCamera>& frames = path_.frames;
  if (frames.empty()) start_s_ = time_s;
  const double time = time_s - start_s_;
  // If consecutive frames have the same camera, only the first and the last are stored.
  const size_t count = frames.size();
  if (count >= 2 && shows_same(frames[count - 2].camera, camera) && shows_same(frames[count - 1].camera, camera)) {
    frames.pop_back();
  }
  if (!frames.empty() && time <= frames.back().time_s) return;
  frames.push_back({time, camera, center});
}

Camera FlightReplay::next_camera(double time_s) {
  const double interval_s = pictures_.interval_s();
  // A delay of less than an interval is made up for. The time of a slow picture or of a pause is not.
  due_s_ = time_s - due_s_ < interval_s ? due_s_ + interval_s : time_s + interval_s;
  return pictures_.camera(next_++);
}

void FlightReplay::add(const FinishedFrame& frame) {
  frame_ms_.push_back(frame.time_ms);
  total_ms_ += frame.time_ms;
  trace_ms_ += frame.stages.trace;
  camera_ray_count_ += frame.rays.primary;
}

std::string FlightReplay::summarize() const {
  const bool took_time = total_ms_ > 0.0;
  return fmt::format(
      "{} frames: median {:.2f} ms, 99th percentile {:.2f} ms, tracing {:.1f} % of the time, {:.2f} million camera "
      "rays a "
      "second",
      frame_ms_.size(), median(frame_ms_), percentile(frame_ms_, 0.99), took_time ? 100.0 * trace_ms_ / total_ms_ : 0.0,
      took_time ? 1e-3 * static_cast<double>(camera_ray_count_) / total_ms_ : 0.0);
}

}  // namespace promin::app
