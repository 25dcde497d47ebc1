// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "promin/device.h"
#include "promin/device_info.h"
#include "promin/image.h"
#include "promin/renderer.h"
#include "work/pictures/quantiles.h"
#include "work/pictures/scene_counts.h"
#include "work/spec/common_spec.h"

namespace promin::work {

/// The content of `--stats`: results and costs of a run. Times are in milliseconds.
struct RunStats {
  gpu::DeviceInfo device;
  std::string scene_file;
  /// The pose of the scene.
  MotionOptions motion = {};
  /// The shutter (RenderSpec::shutter); empty for no motion blur.
  std::optional<double> shutter = std::nullopt;
  /// The frames per second on which the moments of the shutter depend; empty if they depend on none, or only on the
  /// file of a camera path.
  std::optional<double> shutter_fps = std::nullopt;
  /// The choice of instances.
  Instancing instances = Instancing::kAuto;
  SceneCounts scene;
  size_t object_count = 0;
  size_t material_count = 0;
  size_t light_count = 0;
  /// The view; only set for pictures.
  std::optional<View> view;
  /// True if the options name an integrator.
  bool has_named_integrator = false;
  /// The display transform for 8-bit files.
  DisplayTransform display;
  SetupStats setup;
  gpu::KernelStats kernels;
  RayCounts rays;
  /// The accuracies of pictures with an error target: one for each frame, or one for the single picture.
  std::vector<PictureError> errors;
  /// The numbers of the frames of a camera path. `rays` then counts the rays of all frames.
  std::vector<uint32_t> frames;
  /// The time of each repetition in milliseconds; for a path, the median time of each frame.
  std::vector<double> trace_ms;
  double load_ms = 0.0;
  double write_ms = 0.0;
  double total_ms = 0.0;

  /// Returns the median of the times of tracing, in milliseconds.
  double median_trace_ms() const;
  /// Returns the number of all rays divided by the median trace time, or by the time of all frames, in millions per
  /// second; 0 if the time is too short to measure.
  double mrays_per_s() const;
};

/// Returns the mean number of samples per pixel of a picture with an error target.
double mean_samples(const View& view, const PictureError& error);

/// Sets the metadata of a picture with an error target and this number of pixels. Existing entries are replaced, and
/// missing entries are added.
void put_error(Metadata& metadata, const PictureError& error, uint64_t pixel_count);
/// Returns whether put_error() sets an entry of this name.
bool is_error_metadata(std::string_view name);

/// The name of the metadata entry with the version of the program.
inline constexpr std::string_view kVersionEntry = "promin:version";

/// Returns the metadata of an EXR about the run's view.
Metadata describe_picture(const RunStats& stats);

/// Returns the stats as an indented JSON object.
std::string to_json(const RunStats& stats);

}  // namespace promin::work
