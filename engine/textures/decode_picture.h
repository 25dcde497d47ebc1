// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "promin/math.h"

namespace promin {

/// Thrown if a picture cannot be used as a texture. The message is the reason in a few words.
class DecodeError : public std::runtime_error {
 public:
  explicit DecodeError(const std::string& why, bool is_file_at_fault = true)
      : std::runtime_error(why), is_file_at_fault_(is_file_at_fault) {}

  /// Returns whether the file is damaged; false for valid features that promin does not support.
  bool is_file_at_fault() const { return is_file_at_fault_; }

 private:
  bool is_file_at_fault_;
};

/// A picture with 8 bits per channel.
struct DecodedPicture {
  uvec2 size{0};
  /// The texels in the form of TextureImage::texels.
  std::vector<uint32_t> texels;
  /// The library's warning about a damaged file; empty if there is none.
  std::string warning = {};
};

/// Returns the size of a picture. Its first bytes determine its format, one of image/picture_formats.h; formats other
/// than PNG and JPEG need the plugin for pictures. Throws DecodeError if the format is unknown, the file is damaged,
/// the picture is larger than kMaxTextureSide or kMaxTextureTexels, or the plugin is missing.
uvec2 read_picture_size(std::span<const std::byte> file);

/// Returns the texels of a picture in one of these formats. Grey is expanded to three channels, and missing alpha is 1.
/// Values with more than 8 bits are rounded to 8 bits, and values outside 0...1 are clamped. The missing part of a
/// truncated JPEG is grey. Colour profiles and gamma of the file are ignored, as glTF 2.0, section 3.8.3, requires.
/// Throws DecodeError. If the picture is too large, it throws before it allocates memory.
DecodedPicture decode_picture(std::span<const std::byte> file);

/// The largest number of texels of an image: 512 MiB.
inline constexpr uint64_t kMaxTextureTexels = uint64_t{1} << 27;

}  // namespace promin
