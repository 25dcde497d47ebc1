// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/scene.h"

namespace promin {

/// Implements add_default_lights() for promin::Scene and world::Scene.
AddedLights add_default_lights(std::vector<Light>& lights, Environment& environment);

/// Returns the box that a camera frames: the main part of all finite geometry (scene/stray_geometry.h). If nothing is
/// finite, it is a box of size 2 around the first plane's point or the origin. Throws InputError as bounds_of() does.
Bounds frame_of(const Scene& scene);

/// Returns the camera moved along its picture's axes like fit_camera(), so that it shows the whole scene from there and
/// from all positions around the axis `up` through the middle of frame_of(scene). Throws the same errors.
Camera fit_turning_camera(const Scene& scene, const Camera& camera, const vec3& up, float aspect_ratio, float fit);

/// Returns an upward direction as a unit vector. Throws UsageError if it is zero or not finite.
dvec3 normalize_up(const vec3& up);

/// Returns the middle of a box that is not empty, without the rounding of Bounds::center().
inline dvec3 middle_of(const Bounds& bounds) {
  return 0.5 * (dvec3(bounds.lo) + dvec3(bounds.hi));
}

/// Returns the bounds of an object that has a geometry; empty if the geometry is not finite. Throws the same errors as
/// bounds_of().
Bounds bounds_of(const Scene& scene, const Object& object);

/// Returns the fraction of a picture's width or height, whichever is larger, that the box frame_of(scene) covers;
/// infinite if the camera is inside the box or does not have the box completely in front of it.
double covered_share(const Scene& scene, const Camera& camera, float aspect_ratio);

/// Returns a box of size 2 to frame if no geometry is finite.
Bounds bounds_around(const vec3& center);

}  // namespace promin
