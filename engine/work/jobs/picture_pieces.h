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
#include "promin/view.h"
#include "work/spec/common_spec.h"

// The pieces of a job of pictures: the division of pictures into pieces, the names of the pieces, and the pieces of
// each frame.
namespace promin::work {

/// Returns the windows of the pieces of a picture, row by row, for a job with this number of pictures. Throws
/// UsageError if there are more pieces than the picture's window has rows or columns.
std::vector<PixelWindow> cut_picture(const PixelWindow& window, const JobOptions& options, size_t pictures);

/// Returns the names of pieces for the manifest: the parts of each frame, or of the single picture.
std::vector<std::string> name_pieces(const std::vector<std::optional<uint32_t>>& frames,
                                     const std::vector<PixelWindow>& parts);

/// Returns the pieces of each picture of a job, or of the pictures of the given frames in their order. Throws
/// UsageError if the job does not have a frame.
std::vector<std::vector<size_t>> choose_pictures(const jobs::Job& job,
                                                 const std::optional<std::vector<uint32_t>>& frames);
/// Returns whether the job has pieces of several frames.
bool has_several_frames(const jobs::Job& job);
/// Returns the files of a job's pictures. For a path they are the files of each frame, or of the given frames. Throws
/// UsageError if the job does not have a frame.
std::vector<std::filesystem::path> number_pictures(const jobs::Job& job,
                                                   const std::vector<std::filesystem::path>& files,
                                                   const std::optional<std::vector<uint32_t>>& frames);

}  // namespace promin::work
