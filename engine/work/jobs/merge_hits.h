// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "jobs/job.h"
#include "promin/progress.h"

namespace promin::work {

/// Throws UsageError if files are not arrays, or if the job's command needs another number of files.
void check_merged_hits(const jobs::Job& job, const std::vector<std::filesystem::path>& files);
/// Combines the pieces of a job of rays and writes the hits or counts; with --all it writes the offsets to a second
/// file. check_merged_hits() must have checked the files. Throws UsageError for another number of files, RunError,
/// Cancelled, and InputError if pieces do not belong together. Unless `is_mixed`, pieces of different drivers do not
/// belong together.
void merge_hits(const jobs::Job& job, const std::vector<std::filesystem::path>& files, const ProgressCallback& progress,
                bool is_mixed);

}  // namespace promin::work
