// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "options/job_options.h"
#include "output/console.h"
#include "promin/device.h"
#include "work/jobs/planned_job.h"

// Runs jobs for the programs, with messages, progress and signals.
namespace promin::app {

/// The steps of --job that differ between commands.
struct JobSteps {
  /// A function that is called after the job's folder is created, before any work.
  std::function<void()> begin = [] {};
  std::function<gpu::DeviceHandle()> open_device;
  /// The files to write from all pieces.
  std::vector<std::filesystem::path> files;
};
/// Runs a command with --job: makes the missing pieces of its share. Without --piece it then writes the files. It
/// reports on standard output unless quiet. A signal ends the command after the current piece. Throws UsageError if
/// existing pieces were made by another driver.
void run_job(PlannedJob& planned, const JobOptions& options, const JobSteps& steps, const Console& console);

/// Writes a job's files like merge_job(), for a program: a signal ends it without leaving an incomplete file. Returns a
/// description of the result: the files and, if pixels have missed the requested error, their number.
std::string merge_job_deferring(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs);

}  // namespace promin::app
