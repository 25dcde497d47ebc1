// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "promin/device_info.h"
#include "promin/image.h"
#include "promin/renderer.h"
#include "quantiles.h"
#include "scene_counts.h"

namespace promin::app {

/// What one run over a scene made and cost: the content of `--stats`. Times in milliseconds.
struct RunStats {
  gpu::DeviceInfo device;
  std::string scene_file;
  SceneCounts scene;
  size_t object_count = 0;
  size_t material_count = 0;
  size_t light_count = 0;
  /// Of a picture.
  std::optional<View> view;
  SetupStats setup;
  RayCounts rays;
  /// Of a camera path, the numbers of its frames; the rays are those of all.
  std::vector<uint32_t> frames;
  /// Of each repetition; of a path, the median of each frame.
  std::vector<double> trace_ms;
  double load_ms = 0.0;
  double write_ms = 0.0;
  double total_ms = 0.0;

  /// The median.
  double median_trace_ms() const;
  /// All rays over the median trace time, or over that of all frames; 0 where that was too short to measure.
  double mrays_per_s() const;
};

/// What an EXR of the run's view says of it.
Metadata describe_picture(const RunStats& stats);

/// As a JSON object, indented.
std::string to_json(const RunStats& stats);

}  // namespace promin::app
