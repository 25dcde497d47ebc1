// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A solid box aligned with the axes of its own space. A transform must preserve the box's right angles, but may scale
/// each axis by another factor. Sizes lie between 1e-22 and 1e15 in the world.
struct Box {
  /// Centre of the box.
  dvec3 center{0.0};
  /// Distance of the faces from the centre, for each axis.
  dvec3 half_size{0.5};
};

namespace world {
/// A box in the world, stored in the fp32 numbers that the device uses. Error bounds refer to these numbers. The box's
/// axes are the coordinate axes after a rotation.
struct Box {
  /// Centre of the box.
  vec3 center{0.0F};
  /// Distance of the faces from the centre, along each rotated axis.
  vec3 half_size{0.5F};
  /// The vector part of the rotation's unit quaternion, sin(angle / 2) times the axis; the scalar part is positive. The
  /// box's axes can be assigned in 24 ways; the stored rotation has the smallest angle of these. The angle is at most
  /// 63 degrees, so |turn| < 0.53; for a box along the coordinate axes, `turn` is 0.
  vec3 turn{0.0F};
};
}  // namespace world

}  // namespace promin
