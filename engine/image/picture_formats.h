// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "promin/math.h"

namespace promin {

/// A picture format that the plugin reads from memory.
struct PictureFormat {
  /// The format's name in OpenImageIO or in image/plugin/own_formats.h.
  const char* name = "";
  /// The first bytes of such files, '?' for any byte; empty if only is_targa recognises the format.
  std::string_view magic;
  /// Offsets of the little-endian width and height in the header, and the number of bytes of each; 0 bytes if the
  /// reader allocates no memory before it knows the size.
  size_t width_at = 0;
  size_t height_at = 0;
  size_t size_bytes = 0;
};

/// Returns the format of a file. PNG, JPEG, WebP, AVIF, KTX 2.0, BMP, DDS, GIF, OpenEXR and Radiance are recognised by
/// their first bytes. Other files are Targa if their header is plausible, because Targa has no such bytes. Null for
/// other formats.
const PictureFormat* find_picture_format(std::span<const std::byte> file);

/// Returns whether files of this format store linear light, as OpenEXR and Radiance files do, and not sRGB values.
bool holds_light(std::span<const std::byte> file);

/// Returns the size in the header; nullopt if the layout of the header is unknown.
std::optional<uvec2> read_told_size(std::span<const std::byte> file, const PictureFormat& format);

}  // namespace promin
