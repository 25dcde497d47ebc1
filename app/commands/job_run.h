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

// Jobs as the programs run them: with messages, progress and signals.
namespace promin::app {

/// The steps that differ between commands with --job.
struct JobSteps {
  /// Called after the job's folder is created, before any work.
  std::function<void()> begin = [] {};
  std::function<gpu::DeviceHandle()> open_device;
  /// The files to write from all pieces.
  std::vector<std::filesystem::path> files;
};
/// Runs a command with --job: makes the missing pieces of its share, and without --piece then writes the files; reports
/// on standard output unless quiet. A signal ends it after the current piece. Throws UsageError if existing pieces were
/// made by another driver.
void run_job(PlannedJob& planned, const JobOptions& options, const JobSteps& steps, const Console& console);

/// Does what merge_job does for a program: a signal ends it without leaving an incomplete file. Returns a description
/// of the result: the files and, if pixels have missed the requested error, their number.
std::string merge_job_deferring(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs);

}  // namespace promin::app
