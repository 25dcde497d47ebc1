// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/sky_map.h"

#include <cmath>

#include "environment/octahedron.h"

namespace promin {

void SkyMap::fill_border() {
  const int last = side_ - 1;
  for (int i = 0; i < side_; ++i) {
    at(i, -1) = at(last - i, 0);
    at(i, side_) = at(last - i, last);
    at(-1, i) = at(0, last - i);
    at(side_, i) = at(last, last - i);
  }
  // All corners of the map are the direction -Y.
  at(-1, -1) = at(last, last);
  at(side_, side_) = at(0, 0);
  at(-1, side_) = at(last, 0);
  at(side_, -1) = at(0, last);
}

vec4 SkyMap::look_up(const vec3& direction) const {
  const vec2 place = octahedral_place(direction) * static_cast<float>(side_) - 0.5F;
  const auto x = static_cast<int>(place.x + 1.0F) - 1;
  const auto y = static_cast<int>(place.y + 1.0F) - 1;
  const float across = place.x - static_cast<float>(x);
  const float down = place.y - static_cast<float>(y);
  const vec4* row = &at(x, y);
  const vec4* next = row + side_ + 2;
  const vec4 upper = row[0] + across * (row[1] - row[0]);
  const vec4 lower = next[0] + across * (next[1] - next[0]);
  return upper + down * (lower - upper);
}

double solid_angle_density(const dvec2& place) {
  // A face of the octahedron has the distance 1 / sqrt(3) from the centre, and its area is sqrt(3) times that of its
  // projection.
  const dvec3 point = octahedral_point(place);
  const double squared = glm::dot(point, point);
  return 4.0 / (squared * std::sqrt(squared));
}

SkyMap halve(const SkyMap& map) {
  const int side = map.side() / 2;
  SkyMap half(side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      dvec4 sum(0.0);
      double weights = 0.0;
      for (int i = 0; i < 4; ++i) {
        const int from_x = 2 * x + (i & 1);
        const int from_y = 2 * y + (i >> 1);
        const double weight = solid_angle_density((dvec2(from_x, from_y) + 0.5) / static_cast<double>(map.side()));
        sum += weight * dvec4(map.at(from_x, from_y));
        weights += weight;
      }
      half.at(x, y) = vec4(sum / weights);
    }
  }
  half.fill_border();
  return half;
}

}  // namespace promin
