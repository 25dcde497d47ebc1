// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/math.h"

namespace promin {

/// A sky as texels of an octahedral map (environment/octahedron.h), with a border of one texel so that interpolation
/// needs no wrapping.
class SkyMap {
 public:
  explicit SkyMap(int side) : side_(side), texels_(static_cast<size_t>(side + 2) * static_cast<size_t>(side + 2)) {}

  /// Returns the number of texels along a side, without the border.
  int side() const { return side_; }
  /// Returns a texel, linear RGB. x and y are in -1...side(); -1 and side() are the border.
  const vec4& at(int x, int y) const { return texels_[index(x, y)]; }
  vec4& at(int x, int y) { return texels_[index(x, y)]; }

  /// Fills the border with the texels that adjoin the edges on the sphere.
  void fill_border();

  /// Returns the interpolated radiance of a direction of any length except 0.
  vec4 look_up(const vec3& direction) const;

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y + 1) * static_cast<size_t>(side_ + 2) + static_cast<size_t>(x + 1);
  }

  int side_;
  /// The texels. w is unused, because four floats fit into one register.
  std::vector<vec4> texels_;
};

/// Returns the solid angle of a part of the map around a place, divided by its area in the map, in steradian.
double solid_angle_density(const dvec2& place);

/// Returns a map with half the side; the result's side is at least 2. Each texel is the mean of four texels, weighted
/// by their solid angles.
SkyMap halve(const SkyMap& map);

}  // namespace promin
