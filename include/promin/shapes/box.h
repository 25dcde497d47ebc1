// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A solid box along the axes of its space. A transform must keep right angles right; it may stretch each axis by
/// another factor. Sizes lie between 1e-22 and 1e15 in the world.
struct Box {
  /// Its middle.
  dvec3 center{0.0};
  /// Distances of the faces from the middle.
  dvec3 half_size{0.5};
};

namespace world {
/// A box in the world, in the fp32 numbers that a device sees: bounds on errors are about these. Its axes are those of
/// space, turned.
struct Box {
  /// Its middle.
  vec3 center{0.0F};
  /// Distances of the faces from the middle, along the turned axes.
  vec3 half_size{0.5F};
  /// The vector part of the turn's unit quaternion, whose scalar part is positive: sin(angle / 2) times the axis. Of
  /// the 24 ways to name a box's axes the one with the least angle is taken, at most 63 degrees, so that |turn| < 0.53;
  /// along the axes of space it is 0.
  vec3 turn{0.0F};
};
}  // namespace world

}  // namespace promin
