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
/// pixel. Parts are written in any order and read back as rows. It needs 4 bytes per value on disk.
class PictureSpool {
 public:
  /// Creates the spool beside `file`, one of the picture's files. `window` is the rendered part of the whole picture;
  /// `channels` are those in addition to R, G and B, without values. Throws as ScratchFile.
  PictureSpool(const std::filesystem::path& file, const PixelWindow& window, std::vector<Channel> channels);

  /// Writes a part of the window, with values of all channels.
  void write(const PixelWindow& part, const Image& image, const std::vector<Channel>& channels);
  /// Reads a band of whole rows of the window, which must have been written.
  PictureRows read(const PixelWindow& band) const;

 private:
  size_t words_per_pixel() const { return 3 + channels_.size(); }
  uint64_t place_of(const uvec2& pixel) const;

  PixelWindow window_;
  std::vector<Channel> channels_;
  /// Row by row, for each pixel R, G, B and then the channels.
  ScratchFile file_;
};

}  // namespace promin::app
