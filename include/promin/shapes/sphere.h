// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// The ball |P - center| <= radius. A transform must scale it alike in all directions.
struct Sphere {
  dvec3 center{0.0};
  double radius = 0.5;
};

namespace world {
struct Sphere {
  vec3 center{0.0F};
  float radius = 0.5F;
};
}  // namespace world

}  // namespace promin
