// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/sky_pyramid.h"

#include <algorithm>
#include <array>
#include <bit>

namespace promin {
namespace {

/// Returns the light of a texel's square, apart from a constant factor. The map is interpolated, so an eighth of the
/// square's light along each axis comes from the neighbour on either side.
double light_of_texel(const SkyMap& map, int x, int y) {
  constexpr std::array kShares = {0.125, 0.75, 0.125};
  double sum = 0.0;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const vec4& texel = map.at(x + i, y + j);
      const double light = static_cast<double>(texel.x) + static_cast<double>(texel.y) + static_cast<double>(texel.z);
      sum += kShares[static_cast<size_t>(i + 1)] * kShares[static_cast<size_t>(j + 1)] * light;
    }
  }
  const dvec2 place = (dvec2(x, y) + 0.5) / static_cast<double>(map.side());
  return sum * solid_angle_density(place);
}

/// The light of the squares of a level, row by row.
struct SquareLights {
  size_t side = 0;
  std::vector<double> lights;

  double& at(size_t x, size_t y) { return lights[y * side + x]; }
  double at(size_t x, size_t y) const { return lights[y * side + x]; }
};

SquareLights add_quarters(const SquareLights& finer) {
  SquareLights sums{finer.side / 2, std::vector<double>(finer.lights.size() / 4)};
  for (size_t y = 0; y < sums.side; ++y) {
    for (size_t x = 0; x < sums.side; ++x) {
      sums.at(x, y) = finer.at(2 * x, 2 * y) + finer.at(2 * x + 1, 2 * y) + finer.at(2 * x, 2 * y + 1) +
                      finer.at(2 * x + 1, 2 * y + 1);
    }
  }
  return sums;
}

/// Returns the number of entries before those of a level.
size_t first_of_level(uint32_t level) {
  return ((size_t{1} << (2 * level)) - 1) / 3;
}

/// Returns the number of a square in its level: its quarter of the level before, and so on.
size_t number_of_square(size_t x, size_t y, uint32_t level) {
  size_t number = 0;
  for (uint32_t bit = level; bit-- > 0;) number = 4 * number + ((x >> bit & 1) | (y >> bit & 1) << 1);
  return number;
}

glm::uvec4 shares_of(const std::array<double, 4>& lights) {
  const double most = *std::ranges::max_element(lights);
  glm::uvec4 bits(0);
  if (!(most > 0.0)) return bits;
  for (int i = 0; i < 4; ++i) {
    bits[i] = std::bit_cast<uint32_t>(static_cast<float>(lights[static_cast<size_t>(i)] / most));
  }
  return bits;
}

}  // namespace

std::vector<glm::uvec4> make_sky_pyramid(const SkyMap& map, uint32_t levels) {
  const auto side = static_cast<size_t>(map.side());
  SquareLights finer{side, std::vector<double>(side * side)};
  for (size_t y = 0; y < side; ++y) {
    for (size_t x = 0; x < side; ++x) finer.at(x, y) = light_of_texel(map, static_cast<int>(x), static_cast<int>(y));
  }
  while (finer.side > size_t{1} << levels) finer = add_quarters(finer);
  std::vector<glm::uvec4> entries(first_of_level(levels));
  for (uint32_t level = levels; level-- > 0;) {
    const size_t squares = size_t{1} << level;
    for (size_t y = 0; y < squares; ++y) {
      for (size_t x = 0; x < squares; ++x) {
        entries[first_of_level(level) + number_of_square(x, y, level)] =
            shares_of({finer.at(2 * x, 2 * y), finer.at(2 * x + 1, 2 * y), finer.at(2 * x, 2 * y + 1),
                       finer.at(2 * x + 1, 2 * y + 1)});
      }
    }
    finer = add_quarters(finer);
  }
  return entries;
}

}  // namespace promin
