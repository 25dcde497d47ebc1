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

// What the programs and Python do with a command's job: plan it, keep and find what it was planned by, run it.
namespace promin::app {

/// Plans the job of the kind "render" or "cast" by what the command of that name takes, without --output, --job,
/// --piece and what contradicts --job. `folder` is where it is, or will be. `rays` take the place of those of the file
/// that "cast" names, of which the name remains. Throws UsageError, InputError.
std::unique_ptr<PlannedJob> plan_job(const std::string& kind, const std::vector<std::string>& arguments,
                                     const std::filesystem::path& folder, const Console& console,
                                     std::shared_ptr<RaySource> rays = nullptr);

/// Makes the job's folder or goes on with what is in it, and keeps there by what arguments it was planned. Throws what
/// jobs::Job::create does.
jobs::Job create_job(PlannedJob& planned, const std::filesystem::path& folder);

/// Plans the job of a folder again, by what create_job has kept there. Throws InputError where it has kept nothing, or
/// an input is gone, and UsageError where the job would be another one today, as an input has changed.
std::unique_ptr<PlannedJob> plan_again(const jobs::Job& job, const Console& console,
                                       std::shared_ptr<RaySource> rays = nullptr);

/// What the pieces of a job that are there were made on, as driver_of tells it; empty where there is none.
std::string find_driver(const jobs::Job& job);

/// What differs about commands with --job.
struct JobSteps {
  /// Called when the job's folder is there, before any work.
  std::function<void()> begin = [] {};
  std::function<gpu::DeviceHandle()> open_device;
  /// What is made of all pieces.
  std::vector<std::filesystem::path> files;
};
/// Does what a command with --job does: makes the pieces of its share that are missing, and without --piece then the
/// files of them; and says so on standard output unless quiet. A signal ends it with the piece at hand. Throws
/// UsageError where the pieces that are there were made by another driver.
void run_job(PlannedJob& planned, const JobOptions& options, const JobSteps& steps, const Console& console);

}  // namespace promin::app
