// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "jobs/job.h"
#include "promin/progress.h"
#include "promin/renderer.h"

namespace promin::work {

/// Throws UsageError if files are not pictures, or if several frames would be written to one file.
void check_merged_pictures(const jobs::Job& job, const std::vector<std::filesystem::path>& files);
/// Combines the pieces of a job of pictures and writes each picture, or the pictures of the given frames of a path, to
/// files of these names with the frame's number. check_merged_pictures() must have checked the files. Returns the
/// accuracy of pictures with an error target. Calls `progress` before each piece. Throws RunError with some names if
/// pieces are missing, and InputError if pieces are damaged or do not belong together (made by different drivers).
/// Throws UsageError if the job does not have a frame, and Cancelled.
std::optional<PictureError> merge_pictures(const jobs::Job& job, const std::vector<std::filesystem::path>& files,
                                           const ProgressCallback& progress,
                                           const std::optional<std::vector<uint32_t>>& frames = std::nullopt);

}  // namespace promin::work
