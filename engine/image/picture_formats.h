// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "promin/math.h"

namespace promin {

/// A format that the plugin for pictures reads from memory.
struct PictureFormat {
  /// Its name in OpenImageIO or in image/plugin/own_formats.h.
  const char* name = "";
  /// The first bytes of such files, '?' for any byte; empty if only is_targa recognises the format.
  std::string_view magic;
  /// Offsets of the little-endian width and height in the header, and their number of bytes; 0 bytes if the reader
  /// allocates no memory before it knows the size.
  size_t width_at = 0;
  size_t height_at = 0;
  size_t size_bytes = 0;
};

/// Returns the format of a file: PNG, JPEG, WebP, AVIF, KTX 2.0, BMP, DDS, GIF, OpenEXR or Radiance by their first
/// bytes, else Targa if the header is plausible, because Targa has no such bytes. Null for other formats.
const PictureFormat* find_picture_format(std::span<const std::byte> file);

/// Returns whether a file of such a format stores linear light, as OpenEXR and Radiance do, and not sRGB values.
bool holds_light(std::span<const std::byte> file);

/// Returns the size that the header states; nullopt if the header's layout is unknown.
std::optional<uvec2> read_told_size(std::span<const std::byte> file, const PictureFormat& format);

}  // namespace promin
