// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "options/arguments.h"
#include "promin/device.h"
#include "promin/view.h"
#include "scene/world_scene.h"

namespace promin::lab {

using Json = nlohmann::ordered_json;

/// Options of the commands that measure; each command adds the options that it uses.
struct LabOptions {
  /// The names of the scenes, as measure::open_scene() accepts them.
  std::vector<std::string> scenes;
  /// The JSON file for the times of all runs; empty for no file.
  std::filesystem::path output;
  std::optional<std::string> device;
  /// The number of timed runs of each contestant.
  uint32_t runs = 9;
  /// The number of pixels of the camera's picture in each direction.
  uint32_t side = 1024;
  std::string builder = "sah";
  uint32_t max_depth = View().max_depth;
  /// A folder for the rays of a picture, with one .npy file for each set.
  std::optional<std::filesystem::path> rays;
  /// The commit of the sources, as text.
  std::string commit = "unknown";
};

void add_scenes(CLI::App& command, app::OptionTable& table, LabOptions& options);
/// Adds --device, --runs, --side, --commit and --output.
void add_measuring_options(app::OptionTable& table, LabOptions& options, uint32_t fewest_runs);

/// The device and the options of a measurement.
class Session {
 public:
  /// Opens the device. Throws DeviceError.
  explicit Session(const LabOptions& options) : options_(options), device_(gpu::open_device(options.device)) {}

  const LabOptions& options() const { return options_; }
  const gpu::Device& device() const { return *device_; }
  uint32_t runs() const { return options_.runs; }
  uint32_t side() const { return options_.side; }

  /// Prints a line to the standard error stream.
  void say(const std::string& text) const;

  /// Returns the facts on which every figure depends: device, driver, compiler, commit, date, CPU, runs.
  Json provenance() const;

  /// Writes {"provenance", "rates": ...} to the options' output, if they name a file.
  void write(const std::string& section, const Json& content) const;

 private:
  const LabOptions& options_;
  gpu::DeviceHandle device_;
};

/// Returns the view of the scene's first camera, or of a default camera that frames the scene.
View view_of(const world::Scene& scene, const uvec2& size);

// An array of numbers in the JSON has one number for each run: times in one unit, or ratios of two times of the same
// turn. tools/lab/stats.py computes medians and intervals from them.

}  // namespace promin::lab
