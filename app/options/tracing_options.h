// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "output/console.h"
#include "output/work_names.h"
#include "work/spec/common_spec.h"

namespace promin::app {

class OptionTable;

/// Returns the verbosity of the flags. Throws UsageError if both are set.
inline Verbosity verbosity_of(const TracingOptions& options) {
  return verbosity_of(options.is_quiet, options.is_verbose);
}

/// Adds the row of SCENE, which comes first on the command line; add_tracing_options() adds the rows of the other
/// options. `options` must outlive the parsing.
void add_scene_argument(OptionTable& table, TracingOptions& options);
/// Adds the row of the device to open. An empty name is refused, because it is a part of every name.
void add_device_option(OptionTable& table, std::optional<std::string>& device);

/// Adds the row of --instances.
void add_instances_option(OptionTable& table, Instancing& instances);
void add_tracing_options(OptionTable& table, TracingOptions& options);
/// Adds the rows for commands that report at their end what tracing cost.
void add_measuring_options(OptionTable& table, TracingOptions& options);

}  // namespace promin::app
