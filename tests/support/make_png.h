// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <png.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "promin/math.h"

namespace promin {

/// Returns a PNG of rows of samples, as libpng itself writes it.
inline std::vector<std::byte> make_png(const uvec2& size, int color_type, int bit_depth,
                                       const std::vector<uint8_t>& rows, const std::vector<png_color>& palette = {}) {
  std::vector<std::byte> file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &file,
      [](png_structp to, png_bytep bytes, size_t count) {
        auto& out = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(to));
        const auto* first = reinterpret_cast<const std::byte*>(bytes);
        out.insert(out.end(), first, first + count);
      },
      nullptr);
  png_set_IHDR(png, info, size.x, size.y, bit_depth, color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (!palette.empty()) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  png_set_gAMA(png, info, 1.0);
  png_write_info(png, info);
  const size_t row_bytes = rows.size() / size.y;
  for (size_t y = 0; y < size.y; ++y) png_write_row(png, rows.data() + y * row_bytes);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

}  // namespace promin
