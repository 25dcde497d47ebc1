// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// A solid cylinder closed by two disks. A transform must keep circles around the axis circles. Sizes lie between 1e-22
/// and 1e15 in the world.
struct Cylinder {
  /// Middle of the axis.
  dvec3 center{0.0};
  /// Along the cylinder, of any length but 0.
  dvec3 axis{0.0, 1.0, 0.0};
  /// Distance of the two disks from the middle.
  double half_height = 0.25;
  /// Radius of the disks.
  double radius = 0.25;
};

}  // namespace promin
