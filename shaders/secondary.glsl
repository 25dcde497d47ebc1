// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The origins of secondary rays and the directions of mirror rays. `geometric_normal` faces the incoming ray.

// Moves the point off the surface by the bound on its error (SurfacePoint::lift) and no more.
vec3 lift_off(vec3 position, vec3 geometric_normal, float lift) {
  precise vec3 origin = position + lift * geometric_normal;
  return origin;
}

// The unit mirror direction about the shading normal. An interpolated normal may send it into the surface; then the
// surface itself reflects it once more. At grazing rays the two agree.
vec3 reflect_direction(vec3 direction, vec3 normal, vec3 geometric_normal) {
  precise vec3 mirrored = direction - 2.0 * dot3(direction, normal) * normal;
  precise float below = min(0.0, dot3(mirrored, geometric_normal));
  precise vec3 outward = mirrored - 2.0 * below * geometric_normal;
  return normalize3(outward);
}
