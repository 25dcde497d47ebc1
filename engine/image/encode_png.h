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

/// Encodes a PNG file in 8-bit sRGB with libpng. libpng returns from errors by longjmp, so no object with a destructor
/// may be created between setjmp and a call of libpng. Equal pixels of scenes with equal names give equal bytes.
class PngEncoder {
 public:
  /// `bytes` must outlive the encoder. All functions throw RunError if bytes cannot be written, and std::runtime_error
  /// for other failures of libpng. If `scene` is not empty, an iTXt chunk named promin:scene stores it.
  PngEncoder(PictureBytes& bytes, const uvec2& size, bool has_alpha, const std::string& scene = "");
  ~PngEncoder();
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  /// Adds the next rows, with three bytes per pixel, or four with alpha.
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
