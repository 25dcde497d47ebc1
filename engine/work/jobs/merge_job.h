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

/// Checks the files before the work: throws UsageError if merge_job() cannot make the files from this job, or if a file
/// is an input of the job. The manifest identifies inputs by name, size and hash, not by folder. Throws InputError for
/// a job of another kind. `frames` are the frames of a path that will be written.
void check_job_files(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs,
                     const std::optional<std::vector<uint32_t>>& frames = std::nullopt);

/// Writes the files of a job from its pieces: pictures for the kind "render"; hits or counts for "cast", and with --all
/// a second file with the offsets. `is_mixed` only affects rays (merge_hits), `frames` only pictures. Returns the
/// accuracy of pictures with an error target. Throws Cancelled, and the errors of check_job_files(), merge_pictures()
/// and merge_hits().
std::optional<PictureError> merge_job(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs,
                                      const ProgressCallback& progress, bool is_mixed = false,
                                      const std::optional<std::vector<uint32_t>>& frames = std::nullopt);
}  // namespace promin::work
