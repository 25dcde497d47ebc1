// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// (P - point) . normal = 0, infinite. `normal` has any length but 0. Any transform that leaves a normal will do.
struct Plane {
  dvec3 point{0.0};
  dvec3 normal{0.0, 1.0, 0.0};
};

namespace world {
/// `normal` is a unit vector to fp32 rounding.
struct Plane {
  vec3 point{0.0F};
  vec3 normal{0.0F, 1.0F, 0.0F};
};
}  // namespace world

}  // namespace promin
