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
#include "promin/scene.h"
#include "promin/view.h"

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
  /// What a section takes in full, or in a quick report.
  template <typename Value>
  Value pick(Value in_full, Value when_quick) const {
    return is_quick() ? when_quick : in_full;
  }

  /// A line on the standard error stream.
  void say(const std::string& text) const;

  /// The user's scenes, or these of the project; lit where they have no light. Throws InputError.
  std::vector<Scene> load_scenes(const std::vector<std::string>& own) const;

  /// A scene's name in the report, which no other has: see name_scenes.
  std::string name_of(const Scene& scene) const;

 private:
  const ReportOptions& options_;
  /// Of options_.scenes.
  std::vector<std::string> names_;
  gpu::DeviceHandle device_;
};

/// The view of the scene's first camera, or of one that frames it.
View view_of(const Scene& scene, const uvec2& size);

/// Of times in any unit, or of ratios of times of the same turn: {"median", "lower_quartile", "upper_quartile",
/// "interval_lower", "interval_upper", "confidence" (measure::MedianInterval), "runs", "values"}.
/// The values go to runs.csv instead of report.json.
Json json_of_times(const std::vector<double>& times);
/// Of Session::few_runs: {"median", "least", "most", "runs", "values"}.
Json json_of_few_times(const std::vector<double>& times);
/// What takes the place of a figure that was not measured: {"name", "is_installed", "reason"}. The reason is the
/// program's own last line where it is installed and failed; without one it is not installed.
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
/// Beside other renderers.
Json measure_peers(const Session& session);

}  // namespace promin::report
