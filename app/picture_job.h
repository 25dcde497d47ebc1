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

#include "job_options.h"
#include "jobs/job.h"
#include "promin/image.h"
#include "promin/progress.h"
#include "promin/renderer.h"

namespace promin::app {

/// The kind of a job whose pieces are parts of pictures.
inline constexpr std::string_view kPictureJob = "render";

/// The pieces of a picture's window, row by row, where the job has so many pictures. Throws UsageError for more of them
/// than the window has rows or columns.
std::vector<PixelWindow> cut_picture(const PixelWindow& window, const JobOptions& options, size_t pictures);

/// A part of a picture with all that the whole one's files are written with.
struct PicturePart {
  /// Of a camera path.
  std::optional<uint32_t> frame;
  /// Of the whole picture, its window that is rendered, and the part of that.
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
/// Throws InputError, which names the file, where the content is none of a picture.
PicturePart decode_part(const jobs::Content& content, const std::filesystem::path& file);

/// The manifest's names of pieces: of each frame, or of the one picture, its parts.
std::vector<std::string> name_pieces(const std::vector<std::optional<uint32_t>>& frames,
                                     const std::vector<PixelWindow>& parts);

/// The files that a job's pictures go to: of a path those of each frame, or of these. Throws UsageError for a frame
/// that the job does not have.
std::vector<std::filesystem::path> number_pictures(const jobs::Job& job,
                                                   const std::vector<std::filesystem::path>& files,
                                                   const std::optional<std::vector<uint32_t>>& frames);
/// Throws UsageError for files that are no pictures, and where several frames would go to one.
void check_merged_pictures(const jobs::Job& job, const std::vector<std::filesystem::path>& files);
/// Puts the pieces of a job of pictures together and writes each picture, or those of these frames of a path, to the
/// files of these names, with the number of its frame; check_merged_pictures has seen these. Returns what pictures of
/// an error have come to together. Throws RunError where pieces of these pictures are missing, which names some,
/// InputError where pieces do not belong together (made by different drivers) or are damaged, UsageError for a frame
/// that the job does not have, Cancelled where `progress`, which is asked before each piece, says so.
std::optional<PictureError> merge_pictures(const jobs::Job& job, const std::vector<std::filesystem::path>& files,
                                           const ProgressCallback& progress,
                                           const std::optional<std::vector<uint32_t>>& frames = std::nullopt);

}  // namespace promin::app
