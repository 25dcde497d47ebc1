// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// An infinite plane. A transform must not make its normal degenerate.
struct Plane {
  /// Any point of the plane.
  dvec3 point{0.0};
  /// A normal of the plane, of any length except 0.
  dvec3 normal{0.0, 1.0, 0.0};
};

namespace world {
/// A plane in the world in the fp32 numbers that the device uses; error bounds refer to these.
struct Plane {
  /// Any point of the plane.
  vec3 point{0.0F};
  /// A unit vector to fp32 rounding.
  vec3 normal{0.0F, 1.0F, 0.0F};
};
}  // namespace world

}  // namespace promin
