// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "console.h"
#include "render/renderer.h"

namespace promin::app {

class OptionTable;

/// What every command that traces a scene takes.
struct TracingOptions {
  std::filesystem::path scene;
  std::optional<std::filesystem::path> stats;
  /// Name or index of a device.
  std::optional<std::string> device;
  std::string builder = RendererOptions{}.builder;
  uint32_t repeat_count = 1;
  bool is_quiet = false;
  bool is_verbose = false;

  Verbosity verbosity() const;
};

/// The row of SCENE, which comes first on the command line; and those of the others. `options` must outlive the
/// parsing.
void add_scene_argument(OptionTable& table, TracingOptions& options);
void add_tracing_options(OptionTable& table, TracingOptions& options);

/// Throws UsageError for what no single option shows: two that contradict each other.
void check_tracing_options(const TracingOptions& options);

}  // namespace promin::app
