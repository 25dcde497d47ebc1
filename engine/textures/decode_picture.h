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

/// Why a picture is no use as a texture, in a few words.
class PictureError : public std::runtime_error {
 public:
  explicit PictureError(const std::string& why, bool is_file_at_fault = true)
      : std::runtime_error(why), is_file_at_fault_(is_file_at_fault) {}

  /// Whether the file is broken. False for what its format allows and promin does not read.
  bool is_file_at_fault() const { return is_file_at_fault_; }

 private:
  bool is_file_at_fault_;
};

/// A picture of 8 bits a channel.
struct DecodedPicture {
  uvec2 size{0};
  /// As TextureImage::texels.
  std::vector<uint32_t> texels;
  /// What the library complains about while it decodes a damaged file; empty where it does not.
  std::string warning = {};
};

/// The size of a picture, whose first bytes tell its format: one of image/picture_formats.h; for any but PNG and
/// JPEG the plugin for pictures is opened. Throws PictureError where it is of none, is broken, is larger than
/// kMaxTextureSide or kMaxTextureTexels, or the plugin is missing.
uvec2 read_picture_size(std::span<const std::byte> file);

/// The texels of such a file: grey ones in three channels, without alpha 1, numbers of more bits rounded to 8, what is
/// beyond 0...1 clamped. What is missing of a JPEG that ends early is grey. Profiles and gamma of the file are ignored,
/// as glTF 2.0, section 3.8.3, asks for. Throws PictureError, before it takes memory for a picture that is too large.
DecodedPicture decode_picture(std::span<const std::byte> file);

/// Most texels of an image: 512 MiB.
inline constexpr uint64_t kMaxTextureTexels = uint64_t{1} << 27;

}  // namespace promin
