// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// The convex hull of two spheres. If one sphere contains the other, the capsule is the larger sphere. A transform must
/// map spheres to spheres. Sizes lie between 1e-22 and 1e15 in the world.
struct Capsule {
  /// The point halfway between the centres of the spheres.
  dvec3 center{0.0};
  /// Direction from the bottom to the top, of any length except 0.
  dvec3 axis{0.0, 1.0, 0.0};
  /// Distance of the spheres' centres from `center`; it may be 0.
  double half_height = 0.25;
  /// Radius of the sphere at `center` - half_height along the axis. A radius of 0 makes this sphere a point, but at
  /// least one of the radii is larger than 0.
  double radius_bottom = 0.25;
  /// Radius of the sphere at `center` + half_height along the axis.
  double radius_top = 0.25;
};

namespace world {
/// A capsule in the world, stored in the fp32 numbers that the device uses. Error bounds refer to these numbers. The
/// centres of the spheres are center -+ axis * half_height.
struct Capsule {
  /// The point halfway between the centres of the spheres.
  vec3 center{0.0F};
  /// Direction from the bottom to the top; a unit vector up to fp32 rounding.
  vec3 axis{0.0F, 1.0F, 0.0F};
  /// Distance of the spheres' centres from `center`.
  float half_height = 0.25F;
  /// Radius of the sphere at center - axis * half_height.
  float radius_bottom = 0.25F;
  /// Radius of the sphere at center + axis * half_height.
  float radius_top = 0.25F;
};
}  // namespace world

}  // namespace promin
