// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/job.h"
#include "promin/progress.h"
#include "promin/renderer.h"

// The files that a job's pieces make.
namespace promin::app {

/// Before the work: throws UsageError for files that merge_job does not make of this job, and for one that the job's
/// pieces hang on; the manifest tells these by name, size and hash, not by folder. Throws InputError for a job of
/// another kind. `frames`: of a path only these are to be made.
void check_job_files(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs,
                     const std::optional<std::vector<uint32_t>>& frames = std::nullopt);

/// Makes the files of a job of its pieces: pictures of the kind "render"; of "cast" the hits or counts, and of --all
/// the offsets as a second file. `is_mixed` is for rays alone (merge_hits), `frames` for pictures alone. Returns what
/// pictures of an error have come to together. Throws Cancelled, and what check_job_files, merge_pictures and
/// merge_hits do.
std::optional<PictureError> merge_job(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs,
                                      const ProgressCallback& progress, bool is_mixed = false,
                                      const std::optional<std::vector<uint32_t>>& frames = std::nullopt);
/// The same for a program: a signal ends it, and leaves no file half written. Returns what it has made, in words: the
/// files and, where pixels have missed the error that was asked for, how many.
std::string merge_job_deferring(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs);

}  // namespace promin::app
