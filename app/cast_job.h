// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "cast_options.h"
#include "console.h"
#include "jobs/job.h"
#include "planned_job.h"
#include "promin/progress.h"
#include "promin/ray.h"
#include "promin/scene.h"
#include "ray_source.h"

namespace promin::app {

/// The kind of a job whose pieces are answers to rays.
inline constexpr std::string_view kRayJob = "cast";

/// Gives hits the numbers that the file has for its objects.
void number_as_in_file(const Scene& scene, std::span<Hit> hits);

/// The job of rays of checked options, whose command was parsed to them; `rays` are those of the file that it names
/// where they are none. Throws InputError, and UsageError for more pieces than rays.
std::unique_ptr<PlannedJob> plan_rays(const CastOptions& options, const CLI::App& command, const Console& console,
                                      std::shared_ptr<RaySource> rays = nullptr);

/// Throws UsageError for files that are no arrays, and where a command has planned the job for another number of them.
void check_merged_hits(const jobs::Job& job, const std::vector<std::filesystem::path>& files);
/// Writes what the pieces of a job of rays are together: hits, or counts, and of --all the offsets to a second file;
/// check_merged_hits has seen these.
/// Throws UsageError for another number of files, RunError, Cancelled, and InputError where pieces do not belong
/// together; unless `is_mixed`, that is where they were made by different drivers.
void merge_hits(const jobs::Job& job, const std::vector<std::filesystem::path>& files, const ProgressCallback& progress,
                bool is_mixed);

}  // namespace promin::app
