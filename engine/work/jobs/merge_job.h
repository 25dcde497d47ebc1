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

// Writes the files of a job from its pieces.
namespace promin::work {

/// Checks the files before the work: throws UsageError for files that merge_job cannot make from this job, and for a
/// file that is an input of the job; the manifest identifies inputs by name, size and hash, not by folder. Throws
/// InputError for a job of another kind. `frames`: only these frames of a path will be written.
void check_job_files(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs,
                     const std::optional<std::vector<uint32_t>>& frames = std::nullopt);

/// Writes the files of a job from its pieces: pictures for the kind "render"; for "cast" hits or counts, with --all
/// also the offsets as a second file. `is_mixed` only applies to rays (merge_hits), `frames` only to pictures. Returns
/// the accuracy of pictures with an error target. Throws Cancelled, and what check_job_files, merge_pictures and
/// merge_hits do.
std::optional<PictureError> merge_job(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs,
                                      const ProgressCallback& progress, bool is_mixed = false,
                                      const std::optional<std::vector<uint32_t>>& frames = std::nullopt);
}  // namespace promin::work
