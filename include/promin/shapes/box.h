// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A solid box along the axes of its space: |P - center| <= half_size in each component, all of which are positive. A
/// transform must keep right angles right; it may stretch each axis by another factor.
struct Box {
  dvec3 center{0.0};
  dvec3 half_size{0.5};
};

namespace world {
/// Its axes are those of space, turned by the rotation whose unit quaternion has `turn` for vector part and a positive
/// scalar part: sin(angle / 2) times the axis. Of the 24 ways to name the axes the one with the least angle is taken,
/// at most 63 degrees, so that |turn| < 0.53; along the axes of space it is 0.
struct Box {
  vec3 center{0.0F};
  vec3 half_size{0.5F};
  vec3 turn{0.0F};
};
}  // namespace world

}  // namespace promin
