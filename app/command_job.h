// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "console.h"
#include "job_options.h"
#include "jobs/job.h"
#include "planned_job.h"
#include "promin/device.h"
#include "ray_source.h"

// Jobs of commands, for the programs and Python: planning a job, storing and reading its arguments, and running it.
namespace promin::app {

/// Plans the job of the kind "render" or "cast" from arguments of that command, without --output, --job, --piece and
/// options that contradict --job. `folder` is its present or future folder. `rays` replace those of the file that
/// "cast" names; only its name is still used. Throws UsageError, InputError.
std::unique_ptr<PlannedJob> plan_job(const std::string& kind, const std::vector<std::string>& arguments,
                                     const std::filesystem::path& folder, const Console& console,
                                     std::shared_ptr<RaySource> rays = nullptr);

/// Creates the job's folder, or continues the job in it, and stores the job's arguments there. Throws what
/// jobs::Job::create does.
jobs::Job create_job(PlannedJob& planned, const std::filesystem::path& folder);

/// Plans the job of a folder again from the arguments that create_job has stored. Throws InputError if there are none
/// or if an input is missing, and UsageError if an input has changed, so that it would be another job.
std::unique_ptr<PlannedJob> plan_again(const jobs::Job& job, const Console& console,
                                       std::shared_ptr<RaySource> rays = nullptr);

/// Returns the driver_of of the job's finished pieces; empty if there are none.
std::string find_driver(const jobs::Job& job);

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

}  // namespace promin::app
