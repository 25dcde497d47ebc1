// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A cone or frustum, closed by disks unless it is open. The radius changes linearly from one end of the axis to the
/// other; an end with radius 0 is an apex. A transform must map circles around the axis to circles. Sizes lie between
/// 1e-22 and 1e15 in the world.
struct Cone {
  /// Middle of the axis.
  dvec3 center{0.0};
  /// Direction from the bottom to the top, of any length except 0.
  dvec3 axis{0.0, 1.0, 0.0};
  /// Distance of the two ends from `center`.
  double half_height = 0.25;
  /// Radius at `center` - half_height along the axis, 0 or more. At least one of the two radii is larger than 0.
  double radius_bottom = 0.25;
  /// Radius at `center` + half_height along the axis.
  double radius_top = 0.0;
  /// True if the cone consists only of its side, without disks.
  bool is_open = false;
};

namespace world {
/// A cone in the world, stored in the fp32 numbers that the device uses. Error bounds refer to these numbers. The disks
/// lie at center -+ axis * half_height.
struct Cone {
  /// Middle of the axis.
  vec3 center{0.0F};
  /// Direction from the bottom to the top; a unit vector up to fp32 rounding.
  vec3 axis{0.0F, 1.0F, 0.0F};
  /// Distance of the two ends from `center`.
  float half_height = 0.25F;
  /// Radius at center - axis * half_height.
  float radius_bottom = 0.25F;
  /// Radius at center + axis * half_height.
  float radius_top = 0.0F;
  /// True if the cone consists only of its side, without disks.
  bool is_open = false;

  /// Returns whether both cones are equal.
  bool operator==(const Cone&) const = default;
};
}  // namespace world

}  // namespace promin
