// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/math.h"

namespace promin {

/// The projection of the scene to a picture.
enum class Projection {
  /// Rays start at the eye.
  kPerspective,
  /// Rays are parallel to `look`.
  kOrthographic,
};

/// A pose and a projection. The default camera stands at the origin and looks along -Z. validate() (promin/validate.h)
/// checks these rules: all numbers are finite, and `look` and `up` are unit vectors at right angles, each within 0.001.
/// The right of the picture is look x up.
struct Camera {
  /// The display name; empty if there is none.
  std::string name;
  /// The projection; perspective by default.
  Projection projection = Projection::kPerspective;
  /// Position in the world.
  vec3 eye{0.0F};
  /// Unit vector in the direction of view.
  vec3 look{0.0F, 0.0F, -1.0F};
  /// Unit vector towards the top of the picture.
  vec3 up{0.0F, 1.0F, 0.0F};
  /// Vertical field of view of a perspective camera, in radians, in (0, pi).
  float yfov = 0.7F;
  /// Half the height of an orthographic camera's view, in world units, > 0.
  float ymag = 1.0F;
  /// Ratio of width to height that the scene file requests; 0 if the file requests no ratio. Pictures have the ratio of
  /// View::size.
  float aspect_ratio = 0.0F;
  /// The picture size in pixels that the scene file requests; 0 if the file requests no size. Pictures have the size
  /// View::size.
  uvec2 resolution{0};
  /// Distance of the near plane in world units, >= 0. Nothing nearer than this plane is drawn.
  float near = 0.0F;
  /// Radius of the lens in world units, 0 to 1e15; 0 for a camera without a lens, which shows everything sharp.
  float aperture_radius = 0.0F;
  /// Distance of the plane in focus from the eye, along `look`, in world units. It must be positive if there is a lens.
  float focus_distance = 0.0F;
};

/// The smallest distance of a plane in focus.
inline constexpr float kLeastFocusDistance = 1e-15F;

/// Returns whether the camera shows surfaces sharp only at its distance of focus.
inline bool has_lens(const Camera& camera) {
  return camera.aperture_radius > 0.0F;
}

}  // namespace promin
