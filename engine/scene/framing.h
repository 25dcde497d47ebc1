// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/scene.h"

namespace promin {

/// Implements add_default_lights for both forms of a scene.
AddedLights add_default_lights(std::vector<Light>& lights, Environment& environment);

/// Returns the box to look at: the main part of everything finite (scene/stray_geometry.h), else a box of size 2 around
/// the first plane's point or the origin. Throws InputError as bounds_of() does.
Bounds frame_of(const Scene& scene);

/// Returns the middle of a box that is not empty, without the rounding of Bounds::center().
inline dvec3 middle_of(const Bounds& bounds) {
  return 0.5 * (dvec3(bounds.lo) + dvec3(bounds.hi));
}

/// Returns the bounds of an object that has a geometry; empty if it is not finite. Throws as bounds_of() does.
Bounds bounds_of(const Scene& scene, const Object& object);

/// Returns how much of a picture's width or height, whichever is more, the box frame_of(scene) covers; infinite if the
/// camera is in it or before it.
double covered_share(const Scene& scene, const Camera& camera, float aspect_ratio);

/// Returns a box of size 2, to look at if nothing is finite.
Bounds bounds_around(const vec3& center);

}  // namespace promin
