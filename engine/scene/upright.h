// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// The upward direction of the world in most files.
inline constexpr vec3 kUsualUp{0.0F, 1.0F, 0.0F};

/// Returns the shortest rotation from +Y to a unit vector. The columns are the images of X, Y and Z.
inline dmat3 turn_up_to(const dvec3& up) {
  if (up.y <= -1.0 + 1e-12) return dmat3({-1, 0, 0}, {0, -1, 0}, {0, 0, 1});
  const double s = 1.0 / (1.0 + up.y);
  return {{up.y + s * up.z * up.z, -up.x, 0.0 - s * up.x * up.z},
          up,
          {0.0 - s * up.x * up.z, 0.0 - up.z, up.y + s * up.x * up.x}};
}

/// Returns a direction after the shortest rotation from +Y to the unit vector `up`. If `up` is +Y, no bit changes.
inline dvec3 turn_from_y(const vec3& up, const dvec3& direction) {
  return up == kUsualUp ? direction : turn_up_to(glm::normalize(dvec3(up))) * direction;
}

/// Returns a direction after the opposite rotation.
inline dvec3 turn_to_y(const vec3& up, const dvec3& direction) {
  return up == kUsualUp ? direction : direction * turn_up_to(glm::normalize(dvec3(up)));
}

}  // namespace promin
