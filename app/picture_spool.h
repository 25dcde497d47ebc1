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

/// A picture that waits on disk until it is whole, where its files begin with what its last pixel tells: parts go in
/// in any order, and rows come out. It takes 4 bytes a number there.
class PictureSpool {
 public:
  /// Lies beside `file`, one that the picture is to be written to. `window` is what is rendered of the whole picture;
  /// `channels` are those beside R, G and B, without values. Throws as ScratchFile.
  PictureSpool(const std::filesystem::path& file, const PixelWindow& window, std::vector<Channel> channels);

  /// A part of the window, with values of all channels.
  void write(const PixelWindow& part, const Image& image, const std::vector<Channel>& channels);
  /// A band of whole rows of the window, all of which were written.
  PictureRows read(const PixelWindow& band) const;

 private:
  size_t words_per_pixel() const { return 3 + channels_.size(); }
  uint64_t place_of(const uvec2& pixel) const;

  PixelWindow window_;
  std::vector<Channel> channels_;
  /// Row by row, of each pixel R, G, B and then the channels.
  ScratchFile file_;
};

}  // namespace promin::app
