// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/math.h"

namespace promin {

enum class Projection { kPerspective, kOrthographic };

/// A pose and a projection. `look` and `up` are orthonormal to rounding; right = look x up.
struct Camera {
  std::string name;
  Projection projection = Projection::kPerspective;
  vec3 eye{0.0F};
  vec3 look{0.0F, 0.0F, -1.0F};
  vec3 up{0.0F, 1.0F, 0.0F};
  /// Vertical field of view of a perspective camera, radians in (0, pi).
  float yfov = 0.7F;
  /// Half height of what an orthographic camera sees, in world units.
  float ymag = 1.0F;
  /// Width over height that the file asks for; 0 where it does not say.
  float aspect_ratio = 0.0F;
  /// Distance of the viewport plane: nothing nearer is drawn. >= 0.
  float near = 0.0F;
};

}  // namespace promin
