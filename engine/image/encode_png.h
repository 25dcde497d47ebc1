// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <png.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "image/picture_bytes.h"
#include "image/picture_endings.h"
#include "promin/math.h"

namespace promin {

/// A PNG file of sRGB in 8 bits, on its way through libpng, which returns from errors by longjmp: nothing with a
/// destructor may be made between setjmp and a call of libpng. Equal pixels of equal scenes give equal bytes.
class PngEncoder {
 public:
  /// The bytes outlive it. Everything throws RunError where they cannot be written, std::runtime_error where libpng has
  /// another reason. An iTXt chunk named promin:scene holds `scene`, unless that is empty.
  PngEncoder(PictureBytes& bytes, const uvec2& size, bool has_alpha, const std::string& scene = "");
  ~PngEncoder();
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  /// The next rows, of three bytes a pixel or, with alpha, four.
  void write_rows(std::span<const uint8_t> pixels);
  void finish();

 private:
  void write_header(const uvec2& size, bool has_alpha);
  [[noreturn]] void fail() const;

  PictureBytes& bytes_;
  std::string scene_;
  std::string scene_key_{kSceneKey};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::array<char, 256> error_{};
};

}  // namespace promin
