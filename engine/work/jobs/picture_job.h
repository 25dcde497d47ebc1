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

/// Returns the pieces of a picture's window, row by row, for a job of this number of pictures. Throws UsageError for
/// more pieces than the window has rows or columns.
std::vector<PixelWindow> cut_picture(const PixelWindow& window, const JobOptions& options, size_t pictures);

/// A part of a picture, with all data for writing the files of the whole picture.
struct PicturePart {
  /// The frame of a camera path.
  std::optional<uint32_t> frame;
  /// Size of the whole picture, its rendered window, and this part of the window.
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
/// Decodes a piece. Throws InputError with the file's name if the content is not part of a picture.
PicturePart decode_part(const jobs::Content& content, const std::filesystem::path& file);

/// Returns the manifest's names of pieces: the parts of each frame, or of the single picture.
std::vector<std::string> name_pieces(const std::vector<std::optional<uint32_t>>& frames,
                                     const std::vector<PixelWindow>& parts);

/// Returns the files of a job's pictures: for a path those of each frame, or of the given frames. Throws UsageError for
/// a frame that the job does not have.
std::vector<std::filesystem::path> number_pictures(const jobs::Job& job,
                                                   const std::vector<std::filesystem::path>& files,
                                                   const std::optional<std::vector<uint32_t>>& frames);
/// Throws UsageError for files that are not pictures, and if several frames would be written to one file.
void check_merged_pictures(const jobs::Job& job, const std::vector<std::filesystem::path>& files);
/// Puts the pieces of a job of pictures together and writes each picture, or those of the given frames of a path, to
/// files of these names with the frame's number. check_merged_pictures must have checked them. Returns the accuracy of
/// pictures with an error target. Calls `progress` before each piece. Throws RunError with some names if pieces are
/// missing, InputError if pieces are damaged or do not belong together (made by different drivers), UsageError for a
/// frame that the job does not have, and Cancelled.
std::optional<PictureError> merge_pictures(const jobs::Job& job, const std::vector<std::filesystem::path>& files,
                                           const ProgressCallback& progress,
                                           const std::optional<std::vector<uint32_t>>& frames = std::nullopt);

}  // namespace promin::work
