// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "jobs/job.h"
#include "promin/image.h"
#include "promin/renderer.h"

namespace promin::work {

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

/// Encodes a part as the content of a piece (docs/jobs.md).
jobs::Content encode_part(const PicturePart& part);
/// Decodes a piece. Throws InputError with the file's name if the content is not a part of a picture.
PicturePart decode_part(const jobs::Content& content, const std::filesystem::path& file);

/// Returns the width and height of a window.
inline uvec2 size_of(const PixelWindow& window) {
  return window.hi - window.lo;
}

}  // namespace promin::work
