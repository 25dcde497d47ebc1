// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

/// A format that the plugin reads from memory without OpenImageIO. Its functions throw std::runtime_error with the
/// reason.
struct OwnFormat {
  std::string_view name;
  /// Returns width and height of a file.
  std::pair<uint32_t, uint32_t> (*read_size)(std::span<const unsigned char> file);
  /// Fills the pixels, of 4 bytes each, with RGBA from the top row.
  void (*read)(std::span<const unsigned char> file, std::span<unsigned char> pixels);
};

/// Returns the format "avif", "ktx2" or "webp"; null for other names.
const OwnFormat* find_own_format(std::string_view name);

// Functions for WebP, which is read with libwebp. OpenImageIO always multiplies WebP's colours by alpha, and so loses
// the colours where alpha is 0 (OpenImageIO#3917).
std::pair<uint32_t, uint32_t> read_webp_size(std::span<const unsigned char> file);
void read_webp(std::span<const unsigned char> file, std::span<unsigned char> pixels);
/// Quality setting of libwebp; its maximum is 100.
inline constexpr float kWebpQuality = 92.0F;
/// Returns the WebP file of a picture with three or four bytes per pixel. Only alpha is lossless. Throws like the
/// functions of OwnFormat.
std::vector<unsigned char> make_webp(const unsigned char* pixels, uint32_t width, uint32_t height, uint32_t channels);

// Functions for AVIF, which is read with libavif. OpenImageIO reads AVIF only if it was built with a suitable libheif.
std::pair<uint32_t, uint32_t> read_avif_size(std::span<const unsigned char> file);
void read_avif(std::span<const unsigned char> file, std::span<unsigned char> pixels);

/// Functions for KTX 2.0 (Khronos Texture File Format Specification). They read the largest level. It may have 1 to 4
/// channels of 8 bits or UASTC blocks, uncompressed or compressed with Zstandard, or ETC1S blocks compressed with
/// BasisLZ.
std::pair<uint32_t, uint32_t> read_ktx2_size(std::span<const unsigned char> file);
void read_ktx2(std::span<const unsigned char> file, std::span<unsigned char> pixels);
