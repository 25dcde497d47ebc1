// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A solid cone or frustum closed by its disks. The radius goes linearly from `radius_bottom`, half_height before the
/// center along the axis, to `radius_top`, as far behind it; at most one of them is 0 (the apex). `axis` has any length
/// but 0. A transform must keep circles around the axis circles.
struct Cone {
  dvec3 center{0.0};
  dvec3 axis{0.0, 1.0, 0.0};
  double half_height = 0.25;
  double radius_bottom = 0.25;
  double radius_top = 0.0;
};

namespace world {
/// `axis` is a unit vector to fp32 rounding; the disks lie at center -+ axis * half_height.
struct Cone {
  vec3 center{0.0F};
  vec3 axis{0.0F, 1.0F, 0.0F};
  float half_height = 0.25F;
  float radius_bottom = 0.25F;
  float radius_top = 0.0F;
};
}  // namespace world

}  // namespace promin
