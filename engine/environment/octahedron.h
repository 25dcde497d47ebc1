// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "promin/math.h"

// The map of all directions onto a square: directions are projected onto an octahedron, whose upper half is viewed from
// above and whose lower half is unfolded. Coordinates are 0...1. The point (0.5, 0.5) is +Y and the corners are -Y. The
// x axis of the square corresponds to +X and its y axis to +Z. The map needs one division and no angles;
// shaders/shade/environment.glsl has the same map.
namespace promin {

/// Returns the place of a direction, which may have any length except 0.
template <typename Vector3>
glm::vec<2, typename Vector3::value_type> octahedral_place(const Vector3& direction) {
  using Real = typename Vector3::value_type;
  const Real scale = Real(1) / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
  Real x = direction.x * scale;
  Real z = direction.z * scale;
  if (direction.y < Real(0)) {
    const Real folded = std::copysign(Real(1) - std::abs(z), x);
    z = std::copysign(Real(1) - std::abs(x), z);
    x = folded;
  }
  return {Real(0.5) + Real(0.5) * x, Real(0.5) + Real(0.5) * z};
}

/// Returns the point of the octahedron |x| + |y| + |z| = 1 for a place. Normalised, it is the direction of the place.
inline dvec3 octahedral_point(const dvec2& place) {
  double x = 2.0 * place.x - 1.0;
  double z = 2.0 * place.y - 1.0;
  const double y = 1.0 - std::abs(x) - std::abs(z);
  if (y < 0.0) {
    const double folded = std::copysign(1.0 - std::abs(z), x);
    z = std::copysign(1.0 - std::abs(x), z);
    x = folded;
  }
  return {x, y, z};
}

}  // namespace promin
