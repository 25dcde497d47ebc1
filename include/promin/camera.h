// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/math.h"

namespace promin {

/// How a camera maps the scene to its picture.
enum class Projection {
  /// Rays start at the eye.
  kPerspective,
  /// Rays are parallel to `look`.
  kOrthographic,
};

/// A pose and a projection. By default it looks down -Z from the origin. Its rules, which validate()
/// (promin/validate.h) checks: everything is finite, `look` and `up` are unit
/// vectors at right angles, each to 0.001. The picture's right is look x up.
struct Camera {
  /// For people; empty where there is none.
  std::string name;
  /// Perspective by default.
  Projection projection = Projection::kPerspective;
  /// Where the camera is, in the world.
  vec3 eye{0.0F};
  /// Unit vector along the view.
  vec3 look{0.0F, 0.0F, -1.0F};
  /// Unit vector to the top of the picture.
  vec3 up{0.0F, 1.0F, 0.0F};
  /// Vertical field of view of a perspective camera, radians in (0, pi).
  float yfov = 0.7F;
  /// Half height of what an orthographic camera sees, in world units, > 0.
  float ymag = 1.0F;
  /// Width over height that the scene file asks for; 0 where it does not say. Pictures have the ratio of View::size.
  float aspect_ratio = 0.0F;
  /// The size of the picture that the scene file asks for, pixels; 0 where it does not say. Pictures have View::size.
  uvec2 resolution{0};
  /// Distance of the viewport plane in world units, >= 0: nothing nearer is drawn.
  float near = 0.0F;
};

}  // namespace promin
