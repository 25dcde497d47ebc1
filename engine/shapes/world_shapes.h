// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

/// The shapes of promin/shapes.h in the world, in the fp32 numbers that a device sees.
namespace promin::world {

struct Sphere {
  vec3 center{0.0F};
  float radius = 0.5F;
};

/// `normal` is a unit vector to fp32 rounding.
struct Plane {
  vec3 point{0.0F};
  vec3 normal{0.0F, 1.0F, 0.0F};
};

/// `axis` is a unit vector to fp32 rounding; the disks lie at center -+ axis * half_height.
struct Cylinder {
  vec3 center{0.0F};
  vec3 axis{0.0F, 1.0F, 0.0F};
  float half_height = 0.25F;
  float radius = 0.25F;
};

/// `axis` is a unit vector to fp32 rounding; the disks lie at center -+ axis * half_height.
struct Cone {
  vec3 center{0.0F};
  vec3 axis{0.0F, 1.0F, 0.0F};
  float half_height = 0.25F;
  float radius_bottom = 0.25F;
  float radius_top = 0.0F;
};

}  // namespace promin::world
