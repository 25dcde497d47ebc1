// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The list of primitives: a new one is its file, an #include, a line in surface_point and one in traversal.glsl's
// intersect_leaf.

// A hit rebuilt on its primitive.
struct SurfacePoint {
  vec3 position;
  vec3 normal;  // geometric, unit: outward, or as wound
  float lift;   // how far along the normal a secondary ray must start so that rounding cannot bring it back
};

#include "primitives/triangle.glsl"
#include "primitives/sphere.glsl"
#include "primitives/plane.glsl"
#include "primitives/frustum.glsl"
#include "primitives/cylinder.glsl"
#include "primitives/cone.glsl"

SurfacePoint surface_point(Ray ray, Primitive p, Hit hit) {
  if (has(FEATURE_PLANES) && p.c.z == KIND_PLANE) return plane_surface(ray, p, hit);
  if (is_kind(p.c.z, KIND_TRIANGLE, FEATURE_TRIANGLES)) return triangle_surface(p, hit);
  if (is_kind(p.c.z, KIND_SPHERE, FEATURE_SPHERES)) return sphere_surface(ray, p, hit);
  if (is_kind(p.c.z, KIND_CYLINDER, FEATURE_CYLINDERS)) return cylinder_surface(ray, p, hit);
  return cone_surface(ray, p, hit);
}
