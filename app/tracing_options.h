// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "promin/load_scene.h"
#include "promin/renderer.h"

namespace promin::app {

class OptionTable;

/// The options of every command that traces a scene.
struct TracingOptions {
  std::filesystem::path scene;
  LoadOptions load;
  std::optional<std::filesystem::path> stats;
  /// Name or index of a device.
  std::optional<std::string> device;
  std::optional<std::string> builder;
  std::optional<std::filesystem::path> bvh;
  /// Number of threads of the program and of a CPU device; without it each uses one per core.
  std::optional<uint32_t> threads;
  uint32_t repeat_count = 1;
  bool is_quiet = false;
  bool is_verbose = false;

  Verbosity verbosity() const { return verbosity_of(is_quiet, is_verbose); }
};

/// Add the row of SCENE, which comes first on the command line, and those of the other options. `options` must outlive
/// the parsing.
void add_scene_argument(OptionTable& table, TracingOptions& options);
/// Adds the row of the device to open. An empty name is refused, because it is part of every name.
void add_device_option(OptionTable& table, std::optional<std::string>& device);

void add_tracing_options(OptionTable& table, TracingOptions& options);
/// Adds the rows of commands that end and then report what tracing cost.
void add_measuring_options(OptionTable& table, TracingOptions& options);

/// Throws UsageError if two options contradict each other.
void check_tracing_options(const TracingOptions& options);

/// Returns the input files, none of which may be an output.
std::vector<std::filesystem::path> input_files(const TracingOptions& options);

/// Copies the choice of the tree to RendererOptions or CasterOptions.
template <typename Options>
void choose_tree(const TracingOptions& from, Options& to) {
  if (from.builder) to.builder = *from.builder;
  to.bvh = from.bvh;
}

}  // namespace promin::app
