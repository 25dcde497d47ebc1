// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A cylinder, closed by two disks unless it is open. A transform must map circles around the axis to circles. Sizes
/// lie between 1e-22 and 1e15 in the world.
struct Cylinder {
  /// Middle of the axis.
  dvec3 center{0.0};
  /// Direction of the axis, of any length except 0.
  dvec3 axis{0.0, 1.0, 0.0};
  /// Distance of the two disks from `center`.
  double half_height = 0.25;
  /// Radius of the disks.
  double radius = 0.25;
  /// True if the cylinder consists only of its side: a tube without disks.
  bool is_open = false;
};

namespace world {
/// A cylinder in the world, stored in the fp32 numbers that the device uses. Error bounds refer to these numbers. The
/// disks lie at center -+ axis * half_height.
struct Cylinder {
  /// Middle of the axis.
  vec3 center{0.0F};
  /// Direction of the axis; a unit vector up to fp32 rounding.
  vec3 axis{0.0F, 1.0F, 0.0F};
  /// Distance of the two disks from `center`.
  float half_height = 0.25F;
  /// Radius of both disks.
  float radius = 0.25F;
  /// True if the cylinder consists only of its side: a tube without disks.
  bool is_open = false;

  /// Returns whether both cylinders are equal.
  bool operator==(const Cylinder&) const = default;
};
}  // namespace world

}  // namespace promin
