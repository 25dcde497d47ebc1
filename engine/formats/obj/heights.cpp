// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/heights.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/luminance.h"

namespace promin {
namespace {

dvec4 channels_of(uint32_t texel) {
  return dvec4(texel & 0xFF, texel >> 8 & 0xFF, texel >> 16 & 0xFF, texel >> 24) / 255.0;
}

double height_of(uint32_t texel, int channel) {
  const dvec4 rgba = channels_of(texel);
  return channel < 4 ? rgba[channel] : luminance_of(dvec3(rgba));
}

uint32_t encode(const dvec3& normal) {
  uint32_t texel = 0xFF000000U;
  for (int i = 0; i < 3; ++i) texel |= static_cast<uint32_t>(std::lround(127.5 * (normal[i] + 1.0))) << 8 * i;
  return texel;
}

/// The neighbours of the texel `at` in its row or column.
struct Neighbours {
  uint32_t before;
  uint32_t after;

  Neighbours(uint32_t at, uint32_t size, bool is_clamped)
      : before(at > 0 ? at - 1 : (is_clamped ? 0 : size - 1)), after(at + 1 < size ? at + 1 : (is_clamped ? at : 0)) {}
};

}  // namespace

TextureImage make_normals(const TextureImage& picture, const HeightMap& map) {
  const uvec2 size = picture.size;
  std::vector<double> heights;
  heights.reserve(picture.texels.size());
  for (const uint32_t texel : picture.texels) heights.push_back(height_of(texel, map.channel));
  TextureImage normals;
  normals.name = picture.name;
  normals.size = size;
  normals.use = ImageUse::kNormal;
  normals.texels.reserve(picture.texels.size());
  for (uint32_t y = 0; y < size.y; ++y) {
    const Neighbours rows(y, size.y, map.is_clamped);
    for (uint32_t x = 0; x < size.x; ++x) {
      const Neighbours columns(x, size.x, map.is_clamped);
      const auto at = [&](uint32_t column, uint32_t row) { return heights[uint64_t{row} * size.x + column]; };
      // In OBJ files v increases upwards, opposite to the order of the rows.
      const double slope_u = map.height.x * 0.5 * (at(columns.after, y) - at(columns.before, y));
      const double slope_v = map.height.y * 0.5 * (at(x, rows.before) - at(x, rows.after));
      normals.texels.push_back(encode(glm::normalize(dvec3(-slope_u, -slope_v, 1.0))));
    }
  }
  return normals;
}

bool holds_normals(const TextureImage& picture) {
  dvec3 sum(0.0);
  uint64_t vector_count = 0;
  for (const uint32_t texel : picture.texels) {
    const dvec3 color(channels_of(texel));
    const double length = glm::length(2.0 * color - 1.0);
    sum += color;
    if (length >= 0.8 && length <= 1.2) ++vector_count;
  }
  const auto count = static_cast<double>(picture.texels.size());
  return sum.z - std::max(sum.x, sum.y) >= 0.2 * count && static_cast<double>(vector_count) >= 0.95 * count;
}

bool is_flat(const TextureImage& picture) {
  return std::ranges::all_of(picture.texels, [&](uint32_t texel) { return texel == picture.texels.front(); });
}

}  // namespace promin
