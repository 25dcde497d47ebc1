// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A solid cylinder closed by two disks. `center` is the middle of the axis segment, `axis` has any length but 0; the
/// disks lie half_height away along it. A transform must keep circles around the axis circles.
struct Cylinder {
  dvec3 center{0.0};
  dvec3 axis{0.0, 1.0, 0.0};
  double half_height = 0.25;
  double radius = 0.25;
};

namespace world {
/// `axis` is a unit vector to fp32 rounding; the disks lie at center -+ axis * half_height.
struct Cylinder {
  vec3 center{0.0F};
  vec3 axis{0.0F, 1.0F, 0.0F};
  float half_height = 0.25F;
  float radius = 0.25F;
};
}  // namespace world

}  // namespace promin
