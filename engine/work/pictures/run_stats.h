// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "promin/device_info.h"
#include "promin/image.h"
#include "promin/renderer.h"
#include "work/pictures/quantiles.h"
#include "work/pictures/scene_counts.h"

namespace promin::work {

/// The content of `--stats`: results and costs of a run. Times are in milliseconds.
struct RunStats {
  gpu::DeviceInfo device;
  std::string scene_file;
  SceneCounts scene;
  size_t object_count = 0;
  size_t material_count = 0;
  size_t light_count = 0;
  /// Only set for pictures.
  std::optional<View> view;
  /// The display transform for 8-bit files.
  DisplayTransform display;
  SetupStats setup;
  RayCounts rays;
  /// The accuracy of pictures with an error target: of each frame, or of the single picture.
  std::vector<PictureError> errors;
  /// The numbers of a camera path's frames; the rays are then those of all frames.
  std::vector<uint32_t> frames;
  /// The time of each repetition; for a path, the median of each frame.
  std::vector<double> trace_ms;
  double load_ms = 0.0;
  double write_ms = 0.0;
  double total_ms = 0.0;

  /// Returns the median.
  double median_trace_ms() const;
  /// Returns all rays divided by the median trace time, or by the time of all frames; 0 if that was too short to
  /// measure.
  double mrays_per_s() const;
};

/// Returns the mean number of samples per pixel of a picture with an error target.
double mean_samples(const View& view, const PictureError& error);

/// Sets the metadata of a picture with an error target and this number of pixels: replaces existing entries, or appends
/// them.
void put_error(Metadata& metadata, const PictureError& error, uint64_t pixel_count);
/// Returns whether put_error sets an entry of this name.
bool is_error_metadata(std::string_view name);

/// The metadata of a picture that names the version of the program.
inline constexpr std::string_view kVersionEntry = "promin:version";

/// Returns the metadata of an EXR about the run's view.
Metadata describe_picture(const RunStats& stats);

/// Returns the stats as an indented JSON object.
std::string to_json(const RunStats& stats);

}  // namespace promin::work
