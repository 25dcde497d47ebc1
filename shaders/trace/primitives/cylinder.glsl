// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A cylinder, closed by two disks or open: a frustum of slope 0.
#include "trace/primitives/frustum.glsl"

Frustum cylinder_of(Primitive p) { return Frustum(p.a.xyz, p.b.xyz, p.b.w, p.a.w, 0.0, is_frustum_open(p)); }

// Returns the crossing with a cylinder; see intersect_frustum. o + t d lies within 3.4 u (|o - c| + size) of the
// surface, measured at distances of 3 to 1e5 and for rays at an angle of sine 1e-4 to the axis.
Crossing intersect_cylinder(Ray ray, Primitive p) { return intersect_frustum(ray, cylinder_of(p)); }
Inside ends_of_cylinder(Ray ray, Primitive p) { return ends_of_frustum(ray, cylinder_of(p)); }

SurfacePoint cylinder_surface(Ray ray, Primitive p, Hit hit) { return frustum_surface(ray, cylinder_of(p), hit); }
