// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// An infinite plane. Any transform that leaves it a normal will do.
struct Plane {
  /// Any point of it.
  dvec3 point{0.0};
  /// At right angles to it, of any length but 0.
  dvec3 normal{0.0, 1.0, 0.0};
};

namespace world {
/// A plane in the world, in the fp32 numbers that a device sees: bounds on errors are about these.
struct Plane {
  /// Any of its points.
  vec3 point{0.0F};
  /// A unit vector to fp32 rounding.
  vec3 normal{0.0F, 1.0F, 0.0F};
};
}  // namespace world

}  // namespace promin
