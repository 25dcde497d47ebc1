// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/shrink_panorama.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"

namespace promin {
namespace {

/// The old pixels that a new pixel covers along an axis: [first, end). It covers the first and the last one partly.
struct Covered {
  uint32_t first;
  uint32_t end;
  double first_part;
  double last_part;

  double part(uint32_t i) const {
    double covered = 1.0;
    if (i == first) covered -= 1.0 - first_part;
    if (i + 1 == end) covered -= 1.0 - last_part;
    return covered;
  }
};

Covered covered_by(uint32_t i, uint32_t new_count, uint32_t old_count) {
  const double scale = static_cast<double>(old_count) / new_count;
  const double begin = i * scale;
  const double end = i + 1 == new_count ? old_count : (i + 1) * scale;
  const auto first = static_cast<uint32_t>(begin);
  const auto beyond = static_cast<uint32_t>(std::ceil(end));
  return {first, beyond, first + 1 - begin, end - (beyond - 1)};
}

/// Sets each pixel of a row to the mean of the pixels at a distance of up to `reach` on both sides. The row wraps
/// around the sphere.
void blur_row(vec3* row, uint32_t width, uint32_t reach) {
  if (reach == 0) return;
  const std::vector<dvec3> old(row, row + width);
  const uint32_t count = 2 * reach + 1;
  for (uint32_t x = 0; x < width; ++x) {
    // The sum is computed again for each pixel. An incremental sum would keep a rounding error after a sun has left the
    // range.
    dvec3 sum(0.0);
    for (uint32_t i = 0; i < count; ++i) sum += old[(x + width - reach + i) % width];
    row[x] = vec3(sum / static_cast<double>(count));
  }
}

}  // namespace

Panorama shrink_panorama(const Panorama& panorama, uint32_t most_width, unsigned thread_count) {
  const Image& from = *panorama.image;
  const uvec2 size = glm::min(from.size, uvec2(most_width, most_width / 2));
  auto to = std::make_shared<Image>();
  to->size = size;
  to->pixels.resize(static_cast<size_t>(size.x) * size.y);
  std::vector<Covered> columns;
  for (uint32_t x = 0; x < size.x; ++x) columns.push_back(covered_by(x, size.x, from.size.x));
  for_each_index(size.y, thread_count, [&](size_t row) {
    const auto y = static_cast<uint32_t>(row);
    const Covered rows = covered_by(y, size.y, from.size.y);
    std::vector<dvec3> sums(size.x, dvec3(0.0));
    std::vector<double> weights(size.x, 0.0);
    for (uint32_t from_y = rows.first; from_y < rows.end; ++from_y) {
      // The circles of rows are shorter near a pole.
      const double row_weight = rows.part(from_y) * std::sin(std::numbers::pi * (from_y + 0.5) / from.size.y);
      for (uint32_t x = 0; x < size.x; ++x) {
        const Covered& column = columns[x];
        for (uint32_t from_x = column.first; from_x < column.end; ++from_x) {
          const double weight = row_weight * column.part(from_x);
          sums[x] += weight * dvec3(from.at(from_x, from_y));
          weights[x] += weight;
        }
      }
    }
    for (uint32_t x = 0; x < size.x; ++x) to->at(x, y) = vec3(sums[x] / weights[x]);
    const double wanted = size.x / (2.0 * size.y * std::sin(std::numbers::pi * (y + 0.5) / size.y));
    blur_row(&to->at(0, y), size.x, std::min(static_cast<uint32_t>(0.5 * wanted), (size.x - 1) / 2));
  });
  return {to};
}

}  // namespace promin
