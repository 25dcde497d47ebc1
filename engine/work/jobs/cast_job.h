// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "jobs/job.h"
#include "promin/progress.h"
#include "promin/ray.h"
#include "promin/scene.h"
#include "work/jobs/planned_job.h"
#include "work/jobs/ray_source.h"
#include "work/pictures/messages.h"
#include "work/spec/cast_spec.h"

namespace promin::work {

/// The kind of a job whose pieces are results of rays.
inline constexpr std::string_view kRayJob = "cast";

/// Returns the job of the rays of a checked specification. If `rays` is null, the rays are read from the file that the
/// specification names. Throws InputError, and UsageError if there are more pieces than rays.
std::unique_ptr<PlannedJob> plan_rays(const CastSpec& options, const Messages& console,
                                      std::shared_ptr<RaySource> rays = nullptr);

/// Throws UsageError if files are not arrays, or if the job's command needs another number of files.
void check_merged_hits(const jobs::Job& job, const std::vector<std::filesystem::path>& files);
/// Combines the pieces of a job of rays and writes the hits or counts; with --all it writes the offsets to a second
/// file. check_merged_hits() must have checked the files. Throws UsageError for another number of files, RunError,
/// Cancelled, and InputError if pieces do not belong together. Unless `is_mixed`, pieces of different drivers do not
/// belong together.
void merge_hits(const jobs::Job& job, const std::vector<std::filesystem::path>& files, const ProgressCallback& progress,
                bool is_mixed);

}  // namespace promin::work
