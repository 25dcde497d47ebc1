// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/job.h"
#include "promin/image.h"
#include "promin/progress.h"
#include "promin/renderer.h"
#include "work/spec/render_spec.h"

namespace promin::work {

/// The kind of a job whose pieces are parts of pictures.
inline constexpr std::string_view kPictureJob = "render";

/// Returns the windows of the pieces of a picture, row by row, for a job with this number of pictures. Throws
/// UsageError if there are more pieces than the picture's window has rows or columns.
std::vector<PixelWindow> cut_picture(const PixelWindow& window, const JobOptions& options, size_t pictures);

/// A part of a picture, with all data for writing the files of the whole picture.
struct PicturePart {
  /// Number of the frame of a camera path; empty for a single picture.
  std::optional<uint32_t> frame;
  /// Size of the whole picture, the window that is rendered, and the window of this part.
  uvec2 full_size{0};
  PixelWindow window;
  PixelWindow part;
  Metadata metadata;
  ExrOptions exr;
  DisplayTransform display;
  std::optional<PictureError> error;
  Image image;
  std::vector<Channel> channels;
};

jobs::Content encode_part(const PicturePart& part);
/// Decodes a piece. Throws InputError with the file's name if the content is not a part of a picture.
PicturePart decode_part(const jobs::Content& content, const std::filesystem::path& file);

/// Returns the names of pieces for the manifest: the parts of each frame, or of the single picture.
std::vector<std::string> name_pieces(const std::vector<std::optional<uint32_t>>& frames,
                                     const std::vector<PixelWindow>& parts);

/// Returns the files of a job's pictures. For a path they are the files of each frame, or of the given frames. Throws
/// UsageError if the job does not have a frame.
std::vector<std::filesystem::path> number_pictures(const jobs::Job& job,
                                                   const std::vector<std::filesystem::path>& files,
                                                   const std::optional<std::vector<uint32_t>>& frames);
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
