// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// The convex hull of two spheres whose centres lie half_height before and behind the center along the axis; where one
/// sphere holds the other, that sphere. `axis` has any length but 0; half_height may be 0, and one of the radii, which
/// makes that end a point. A transform must keep spheres spheres.
struct Capsule {
  dvec3 center{0.0};
  dvec3 axis{0.0, 1.0, 0.0};
  double half_height = 0.25;
  double radius_bottom = 0.25;
  double radius_top = 0.25;
};

namespace world {
/// `axis` is a unit vector to fp32 rounding; the spheres are around center -+ axis * half_height.
struct Capsule {
  vec3 center{0.0F};
  vec3 axis{0.0F, 1.0F, 0.0F};
  float half_height = 0.25F;
  float radius_bottom = 0.25F;
  float radius_top = 0.25F;
};
}  // namespace world

}  // namespace promin
