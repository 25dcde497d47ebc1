// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/picture_bytes.h"
#include "promin/math.h"

namespace promin {

/// Encodes a JPEG file in 8-bit sRGB without chroma subsampling (4:4:4), with libjpeg-turbo, which needs the whole
/// picture. Equal pixels give equal bytes.
class JpegEncoder {
 public:
  /// Quality setting of libjpeg-turbo; its maximum is 100.
  static constexpr int kQuality = 92;

  /// `bytes` must outlive the encoder. All functions throw RunError if bytes cannot be written, and std::runtime_error
  /// for other failures of libjpeg-turbo, for example if a side has more than 65500 pixels.
  JpegEncoder(PictureBytes& bytes, const uvec2& size);

  /// Adds the next rows, with three bytes per pixel.
  void write_rows(std::span<const uint8_t> pixels);
  void finish();

 private:
  PictureBytes& bytes_;
  uvec2 size_;
  std::vector<uint8_t> pixels_;
};

}  // namespace promin
