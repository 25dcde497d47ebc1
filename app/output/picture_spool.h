// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/scratch_file.h"
#include "promin/image.h"
#include "promin/view.h"

namespace promin::app {

/// Rows of a picture with all their channels.
struct PictureRows {
  Image image;
  std::vector<Channel> channels;
};

/// A picture that is kept on disk until it is complete, because its files begin with data that depends on the last
/// pixel. Parts are written in any order and read as rows. It needs 4 bytes of disk space per value.
class PictureSpool {
 public:
  /// Creates the spool beside `file`, one of the picture's files. `window` is the rendered part of the whole picture;
  /// `channels` are the channels in addition to R, G and B, without values. Throws the same errors as ScratchFile.
  PictureSpool(const std::filesystem::path& file, const PixelWindow& window, std::vector<Channel> channels);

  /// Writes a part of the window, with values of all channels.
  void write(const PixelWindow& part, const Image& image, const std::vector<Channel>& channels);
  /// Returns a band of whole rows of the window. All of its pixels must have been written.
  PictureRows read(const PixelWindow& band) const;

 private:
  size_t words_per_pixel() const { return 3 + channels_.size(); }
  uint64_t place_of(const uvec2& pixel) const;

  PixelWindow window_;
  std::vector<Channel> channels_;
  /// The values row by row: for each pixel R, G, B and then the other channels.
  ScratchFile file_;
};

}  // namespace promin::app
