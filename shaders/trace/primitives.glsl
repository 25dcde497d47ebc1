// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The primitives that promin/kinds/primitives.def lists, each with its file in primitives/.

// A hit point, computed again from its primitive.
struct SurfacePoint {
  vec3 position;
  vec3 normal;  // geometric unit normal: outward on solids, by the winding on triangles
  float lift;   // length along the normal at which a secondary ray starts, so that rounding cannot put it on the other
                // side
};

#include "trace/primitives/triangle.glsl"
#include "trace/primitives/sphere.glsl"
#include "trace/primitives/plane.glsl"
#include "trace/primitives/cylinder.glsl"
#include "trace/primitives/cone.glsl"
#include "trace/primitives/box.glsl"
#include "trace/primitives/capsule.glsl"
#include "trace/instances.glsl"

SurfacePoint surface_point(Ray ray, Primitive p, Hit hit) {
  if (is_instance_part(hit.part)) return instance_surface(p, hit);
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (has(FEATURE_##FEATURE) && kind_of(p) == NUMBER) return PREFIX##_surface(ray, p, hit);
#include "promin/kinds/primitives.def"
#define PROMIN_TREE_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (has(FEATURE_##FEATURE) && (TREE_KIND_COUNT == 1u || kind_of(p) == NUMBER)) return PREFIX##_surface(ray, p, hit);
#include "promin/kinds/primitives.def"
  // The pipeline was compiled without this kind, so such a primitive cannot be hit.
  return SurfacePoint(vec3(0.0), vec3(0.0), 0.0);
}
