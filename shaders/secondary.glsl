// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Where secondary rays start and where mirrors send them. `geometric_normal` faces the incoming ray.

// Off the surface by the bound on the position's error (SurfacePoint::lift) and no more.
vec3 lift_off(vec3 position, vec3 geometric_normal, float lift) {
  precise vec3 origin = position + lift * geometric_normal;
  return origin;
}

// The unit mirror direction about the shading normal. Where that would enter the surface, which an interpolated normal
// can do, the surface itself reflects it once more; at grazing rays the two agree.
vec3 reflect_direction(vec3 direction, vec3 normal, vec3 geometric_normal) {
  precise vec3 mirrored = direction - 2.0 * dot3(direction, normal) * normal;
  precise float below = min(0.0, dot3(mirrored, geometric_normal));
  precise vec3 outward = mirrored - 2.0 * below * geometric_normal;
  return normalize3(outward);
}
