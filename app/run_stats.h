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

/// The content of `--stats`: what one run over a scene made and cost. Times are in milliseconds.
struct RunStats {
  gpu::DeviceInfo device;
  std::string scene_file;
  SceneCounts scene;
  size_t object_count = 0;
  size_t material_count = 0;
  size_t light_count = 0;
  /// Only set for pictures.
  std::optional<View> view;
  /// How the picture is shown in files of 8 bits.
  DisplayTransform display;
  SetupStats setup;
  RayCounts rays;
  /// Of pictures with an error target: of each frame, or of the one picture.
  std::vector<PictureError> errors;
  /// The numbers of a camera path's frames; the rays are then those of all frames.
  std::vector<uint32_t> frames;
  /// The time of each repetition; for a path, the median of each frame.
  std::vector<double> trace_ms;
  double load_ms = 0.0;
  double write_ms = 0.0;
  double total_ms = 0.0;

  /// The median.
  double median_trace_ms() const;
  /// All rays over the median trace time, or over the time of all frames; 0 where that was too short to measure.
  double mrays_per_s() const;
};

/// Of a picture with an error target, a pixel.
double mean_samples(const View& view, const PictureError& error);

/// What metadata say of a picture with an error target, of so many pixels: put where it is or at their end.
void put_error(Metadata& metadata, const PictureError& error, uint64_t pixel_count);
/// Whether an entry of this name is put there by put_error.
bool is_error_metadata(std::string_view name);

/// The metadata of an EXR about the run's view.
Metadata describe_picture(const RunStats& stats);

/// Writes the stats as a JSON object, indented.
std::string to_json(const RunStats& stats);

}  // namespace promin::app
