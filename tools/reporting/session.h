// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "promin/device.h"
#include "promin/view.h"
#include "scene/world_scene.h"

namespace promin::report {

using Json = nlohmann::ordered_json;

struct ReportOptions {
  /// Files; without any the project's own scenes are taken, as each section names them.
  std::vector<std::filesystem::path> scenes;
  std::filesystem::path output;
  std::optional<std::filesystem::path> compare;
  std::optional<std::string> device;
  /// Few runs and small sizes: to see that all works, not to learn how fast it is.
  bool is_quick = false;
  std::optional<uint32_t> runs;
  /// Pixels of the camera rays' picture each way, where rays alone are cast.
  std::optional<uint32_t> side;
  std::string builder = "sah";
  /// Mirror bounces of the pictures that are set beside their own rays.
  uint32_t max_depth = View().max_depth;
  /// A folder for the rays of these pictures, a .npy file a set.
  std::optional<std::filesystem::path> rays;
  /// Names of sections; without any all.
  std::vector<std::string> only;
  /// A folder for the pictures of frames, row by row, to be judged by other programs.
  std::optional<std::filesystem::path> pictures;
  /// Of the sources, as the caller knows it.
  std::string commit = "unknown";
};

/// What all sections measure with.
class Session {
 public:
  /// Throws DeviceError.
  explicit Session(const ReportOptions& options);

  const ReportOptions& options() const { return options_; }
  const gpu::Device& device() const { return *device_; }
  bool is_quick() const { return options_.is_quick; }
  /// Timed runs of each contestant.
  uint32_t runs() const { return options_.runs.value_or(is_quick() ? 3 : 20); }
  /// Of what takes seconds and is timed less often; each figure tells of how many.
  uint32_t few_runs() const { return pick(std::min(5U, runs()), 1U); }
  /// Of the camera rays' picture, each way.
  uint32_t side() const { return options_.side.value_or(pick(512U, 96U)); }
  /// What a section takes in full, or in a quick report.
  template <typename Value>
  Value pick(Value in_full, Value when_quick) const {
    return is_quick() ? when_quick : in_full;
  }

  /// A line on the standard error stream.
  void say(const std::string& text) const;

  /// The user's scenes, or these: files of the project or words of measure::open_scene. Throws InputError.
  std::vector<world::Scene> open_scenes(const std::vector<std::string>& own) const;
  /// As open_scenes, lit where they have no light.
  std::vector<world::Scene> load_scenes(const std::vector<std::string>& own) const;

  /// A scene's name in the report, which no other has: see name_scenes.
  std::string name_of(const world::Scene& scene) const;

 private:
  const ReportOptions& options_;
  /// Of options_.scenes.
  std::vector<std::string> names_;
  gpu::DeviceHandle device_;
};

/// The view of the scene's first camera, or of one that frames it.
View view_of(const world::Scene& scene, const uvec2& size);

// Times in a row, in any unit, and ratios of times of the same turn, are arrays with one number a run. What they come
// to (medians, intervals, fronts, exponents) is computed in one place, tools/reporting/stats.py.

/// Times of Session::few_runs: {"few": [...]}.
Json json_of_few(const std::vector<double>& times);
/// What takes the place of a figure that was not measured: {"name", "is_installed", "reason"}. The reason is why, where
/// it is installed; without one it is not installed.
Json json_of_gap(const std::string& name, const std::optional<std::string>& failure);

// The sections, each an object with "rows"; a row has an "id" that is unique in its section. What is not measured is
// left out of a row, never filled in.

/// Per primitive and method: nanoseconds a test and errors; and the errors over distance and offset ("range").
Json measure_kernels(const Session& session);
Json measure_boxes(const Session& session);
/// Whole pictures: error against time, a curve a knob; and the errors apart.
Json measure_frames(const Session& session);
/// What robustness and specialisation cost and bring.
Json measure_robustness(const Session& session);
Json measure_specialisation(const Session& session);
/// Time and steps over triangles, pixels, sources and depth.
Json measure_scaling(const Session& session);
/// Rays, builds, and pictures over their own rays, beside Embree's.
Json measure_rates(const Session& session);
/// The same of one scene: appends to the arrays "rows" and "builds", and what add_picture_over_rays does. Without runs
/// it only counts steps.
void add_rates(const Session& session, const world::Scene& scene, Json& rates);

}  // namespace promin::report
