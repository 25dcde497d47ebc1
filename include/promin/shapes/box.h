// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A solid box aligned with the axes of its own space. A transform must preserve its right angles, but may scale each
/// axis by another factor. Sizes lie between 1e-22 and 1e15 in the world.
struct Box {
  /// Its middle.
  dvec3 center{0.0};
  /// Distances of the faces from the middle.
  dvec3 half_size{0.5};
};

namespace world {
/// A box in the world in the fp32 numbers that the device uses; error bounds refer to these. Its axes are the
/// coordinate axes after a rotation.
struct Box {
  /// Its middle.
  vec3 center{0.0F};
  /// Distances of the faces from the middle, along the rotated axes.
  vec3 half_size{0.5F};
  /// The vector part of the rotation's unit quaternion, sin(angle / 2) times the axis; the scalar part is positive. Of
  /// the 24 ways to assign the box's axes, the one with the smallest angle is used. It is at most 63 degrees, so |turn|
  /// < 0.53; for a box along the coordinate axes it is 0.
  vec3 turn{0.0F};
};
}  // namespace world

}  // namespace promin
