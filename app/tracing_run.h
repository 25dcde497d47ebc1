// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "console.h"
#include "formats/source_file.h"
#include "promin/device.h"
#include "promin/scene.h"
#include "run_stats.h"
#include "tracing_options.h"

namespace promin::app {

// The steps that every command which traces a scene takes. Each reports to the console and leaves its times in the
// stats.

/// As many threads as the options say, for the program and for a device that is the host's processor.
void choose_threads(const TracingOptions& options);

/// Reports the scene's files as load_scene does. Throws InputError.
Scene load_for(const TracingOptions& options, RunStats& stats, const Console& console,
               std::vector<SourceFile>& sources);
/// For check_overwrites, which before the scene is loaded knows of none but the scene's own.
std::vector<std::filesystem::path> files_of(const std::vector<SourceFile>& sources);

/// Throws DeviceError.
gpu::DeviceHandle open_device_for(const TracingOptions& options, RunStats& stats, const Console& console);

/// Takes over what setting the scene up has cost.
void take_setup(const SetupStats& setup, RunStats& stats, const Console& console);

/// Tells what tracing and writing took, the memory of the whole, once stats.total_ms is there.
void tell_end(const RunStats& stats, const Console& console);

/// Throws RunError if the validation layers have reported anything: then nothing is written.
void check_validation(const gpu::Device& device, const RunStats& stats);

}  // namespace promin::app
