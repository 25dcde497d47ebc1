// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A cone or frustum, closed by its disks or open.
#include "trace/primitives/frustum.glsl"

Frustum cone_of(Primitive p) {
  float radius_bottom = p.a.w;
  float radius_top = uintBitsToFloat(has(FEATURE_OPEN_SHAPES) ? p.c.x & ~SHAPE_IS_OPEN : p.c.x);
  precise float radius = 0.5 * (radius_bottom + radius_top);
  precise float slope = (radius_top - radius_bottom) / (2.0 * p.b.w);
  return Frustum(p.a.xyz, p.b.xyz, p.b.w, radius, slope, is_frustum_open(p));
}

// Returns the crossing with a cone; see intersect_frustum. o + t d lies within 4.1 u (|o - c| + size) of the surface,
// measured for half angles of 0.1 to 89.9 degrees.
Crossing intersect_cone(Ray ray, Primitive p) { return intersect_frustum(ray, cone_of(p)); }
Inside ends_of_cone(Ray ray, Primitive p) { return ends_of_frustum(ray, cone_of(p)); }

SurfacePoint cone_surface(Ray ray, Primitive p, Hit hit) { return frustum_surface(ray, cone_of(p), hit); }
