// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The origins of secondary rays and the directions of mirror rays. `geometric_normal` faces the incoming ray.

// Returns the point moved off the surface by exactly the bound on its error (SurfacePoint::lift).
vec3 lift_off(vec3 position, vec3 geometric_normal, float lift) {
  precise vec3 origin = position + lift * geometric_normal;
  return origin;
}

// Returns the unit mirror direction about the shading normal. If an interpolated normal leads into the surface, the
// direction is reflected again at the surface itself. For grazing rays both results agree.
vec3 reflect_direction(vec3 direction, vec3 normal, vec3 geometric_normal) {
  precise vec3 mirrored = direction - 2.0 * dot3(direction, normal) * normal;
  precise float below = min(0.0, dot3(mirrored, geometric_normal));
  precise vec3 outward = mirrored - 2.0 * below * geometric_normal;
  return normalize3(outward);
}
