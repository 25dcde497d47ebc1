// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// An infinite plane. A transform must not map its normal to 0.
struct Plane {
  /// Any point of the plane.
  dvec3 point{0.0};
  /// A normal of the plane, of any length except 0.
  dvec3 normal{0.0, 1.0, 0.0};
};

namespace world {
/// A plane in the world, stored in the fp32 numbers that the device uses. Error bounds refer to these numbers.
struct Plane {
  /// Any point of the plane.
  vec3 point{0.0F};
  /// The plane's normal; a unit vector up to fp32 rounding.
  vec3 normal{0.0F, 1.0F, 0.0F};
};
}  // namespace world

}  // namespace promin
