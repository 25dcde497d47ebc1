// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

/// A format that is read from memory without OpenImageIO. Its functions throw std::runtime_error with the reason.
struct OwnFormat {
  std::string_view name;
  /// Width and height of a file.
  std::pair<uint32_t, uint32_t> (*read_size)(std::span<const unsigned char> file);
  /// Fills the pixels, of 4 bytes each, with RGBA from the top row.
  void (*read)(std::span<const unsigned char> file, std::span<unsigned char> pixels);
};

/// Returns the format "avif", "ktx2" or "webp"; null for other names.
const OwnFormat* find_own_format(std::string_view name);

// WebP is read by libwebp, because OpenImageIO always multiplies its colours by alpha and so loses those under alpha 0
// (OpenImageIO#3917).
std::pair<uint32_t, uint32_t> read_webp_size(std::span<const unsigned char> file);
void read_webp(std::span<const unsigned char> file, std::span<unsigned char> pixels);
/// Quality of libwebp, of 100.
inline constexpr float kWebpQuality = 92.0F;
/// Returns the WebP file of a picture of three or four bytes per pixel; only alpha is lossless. Throws as OwnFormat's
/// functions.
std::vector<unsigned char> make_webp(const unsigned char* pixels, uint32_t width, uint32_t height, uint32_t channels);

// AVIF is read by libavif, because OpenImageIO reads it only if it was built with a suitable libheif.
std::pair<uint32_t, uint32_t> read_avif_size(std::span<const unsigned char> file);
void read_avif(std::span<const unsigned char> file, std::span<unsigned char> pixels);

/// KTX 2.0 (Khronos Texture File Format Specification): the largest level of 1 to 4 channels of 8 bits or of UASTC
/// blocks, as it is or supercompressed by Zstandard, or of ETC1S blocks supercompressed by BasisLZ.
std::pair<uint32_t, uint32_t> read_ktx2_size(std::span<const unsigned char> file);
void read_ktx2(std::span<const unsigned char> file, std::span<unsigned char> pixels);
