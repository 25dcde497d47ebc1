// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A solid sphere. A transform must scale all directions equally. The radius lies between 1e-22 and 1e15 in the world.
struct Sphere {
  /// Centre of the sphere.
  dvec3 center{0.0};
  /// Distance of the surface from the centre.
  double radius = 0.5;
};

namespace world {
/// A sphere in the world, stored in the fp32 numbers that the device uses. Error bounds refer to these numbers.
struct Sphere {
  /// Centre of the sphere.
  vec3 center{0.0F};
  /// Distance of the surface from the centre.
  float radius = 0.5F;
};
}  // namespace world

}  // namespace promin
