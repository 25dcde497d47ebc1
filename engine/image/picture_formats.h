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
  /// OpenImageIO's name of it, or one of image/plugin/own_formats.h.
  const char* name = "";
  /// What files begin with, '?' for any byte; empty where only is_targa recognises the format.
  std::string_view magic;
  /// Where the header holds width and height, little-endian, in how many bytes; 0 bytes where what reads it takes no
  /// memory for the picture before the size is known.
  size_t width_at = 0;
  size_t height_at = 0;
  size_t size_bytes = 0;
};

/// The format of a file: PNG, JPEG, WebP, AVIF, KTX 2.0, BMP, DDS, GIF, OpenEXR or Radiance by their first bytes, else
/// Targa where the header can be Targa's, which has no such bytes. Null for any other format.
const PictureFormat* find_picture_format(std::span<const std::byte> file);

/// Whether a file of such a format holds numbers of light, as OpenEXR and Radiance do, and not codes of sRGB.
bool holds_light(std::span<const std::byte> file);

/// The size that the header states; nullopt where the header's layout is not known.
std::optional<uvec2> read_told_size(std::span<const std::byte> file, const PictureFormat& format);

}  // namespace promin
