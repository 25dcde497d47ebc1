// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/ray_counts.h"

namespace promin::app {

/// Device times of a frame's stages, in milliseconds; 0 if the queue has no timestamps.
struct StageTimes {
  double trace = 0.0;
  /// Time for encoding the picture for the display.
  double display = 0.0;
};

/// The data of a traced frame after the device has finished it.
struct FinishedFrame {
  StageTimes stages;
  RayCounts rays;
  /// True if the driver has cut loops (trace/film/film.h), so that pixels are wrong.
  bool has_cut_loops = false;
  /// The amount of tracing, in units (ProgressivePicture::record).
  double units = 0.0;
  /// True if the frame traced samples of refinement (ProgressivePicture::has_recorded_list).
  bool has_list = false;
  /// True if the frame shows the next camera of a flight.
  bool is_of_flight = false;
  /// Milliseconds from the frame's first request, or from the end of the previous frame if that was later, to the
  /// frame's end. Idle time does not count.
  double time_ms = 0.0;
};

}  // namespace promin::app
