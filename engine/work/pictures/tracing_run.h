// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/source_file.h"
#include "promin/device.h"
#include "promin/scene.h"
#include "work/pictures/messages.h"
#include "work/pictures/run_stats.h"
#include "work/spec/common_spec.h"

namespace promin::work {

// The steps of commands that trace a scene. Each step reports to the console and stores its times in the stats.

/// Sets the number of threads of the program and of a CPU device from the options.
void choose_threads(const TracingOptions& options);

/// Loads the scene and reports its files. Throws InputError.
Scene load_for(const TracingOptions& options, RunStats& stats, const Messages& console,
               std::vector<SourceFile>& sources);
/// Returns the names of the scene's files for check_overwrites(), which knows only the main file before the scene is
/// loaded.
std::vector<std::filesystem::path> files_of(const std::vector<SourceFile>& sources);

/// Opens the device of the options. Throws DeviceError.
gpu::DeviceHandle open_device_for(const TracingOptions& options, RunStats& stats, const Messages& console);

/// Stores the cost of setting up the scene, and the counts of the device's kernels.
void take_setup(const SetupStats& setup, const gpu::Device& device, RunStats& stats, const Messages& console);

/// Reports the times of tracing and writing and the memory use, after stats.total_ms is set.
void tell_end(const RunStats& stats, const Messages& console);

/// Throws RunError if the validation layers have reported anything. No file is then written.
void check_validation(const gpu::Device& device, const RunStats& stats);

}  // namespace promin::work
