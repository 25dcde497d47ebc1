// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/picture_bytes.h"
#include "promin/math.h"

namespace promin {

/// A JPEG file of sRGB in 8 bits, without subsampling of colours (4:4:4), by libjpeg-turbo, which takes the picture as
/// a whole. Equal pixels give equal bytes.
class JpegEncoder {
 public:
  /// libjpeg-turbo's, of 100.
  static constexpr int kQuality = 92;

  /// The bytes outlive it. Everything throws RunError where they cannot be written, std::runtime_error where
  /// libjpeg-turbo has another reason, as a side of more than 65500 pixels.
  JpegEncoder(PictureBytes& bytes, const uvec2& size);

  /// The next rows, of three bytes a pixel.
  void write_rows(std::span<const uint8_t> pixels);
  void finish();

 private:
  PictureBytes& bytes_;
  uvec2 size_;
  std::vector<uint8_t> pixels_;
};

}  // namespace promin
