// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Shading (docs/model.md, "Light") of a point that a ray hit.

// The data of a hit that the light loop and the mirror ray need.
struct ShadingPoint {
  vec3 position;
  vec3 geometric_normal;  // unit; faces the incoming ray
  vec3 normal;            // the interpolated normal or the geometric one; faces the incoming ray
  float lift;
  vec3 shadow_position;  // origin of shadow rays, before the lift
  vec3 color;            // vertex colour
  MaterialRecord material;
  vec2 lobe_shares;  // with FEATURE_METALLIC_ROUGHNESS
};

#include "materials.glsl"

// Lifts the point onto the curved surface that the vertex normals suggest, so that its own coarse polygon does not
// shadow what is shaded as lit (Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II ch. 4).
vec3 lift_to_curve(vec3 position, vec3 corner, vec3 normal) {
  precise float height = min(0.0, dot3(position - corner, normal));
  precise vec3 projected = position - height * normal;
  return projected;
}

void apply_vertex_normals(inout ShadingPoint point, Primitive p, uvec3 corners, vec3 weights, bool is_flipped) {
  vec3 n0 = load_vertex(VIEW.first_index.z + corners.x);
  vec3 n1 = load_vertex(VIEW.first_index.z + corners.y);
  vec3 n2 = load_vertex(VIEW.first_index.z + corners.z);
  // The side of the geometric normal decides which way the interpolated normal faces, so the sign of the latter stays
  // as wound.
  float side = is_flipped ? -1.0 : 1.0;
  precise vec3 interpolated = (weights.x * n0 + weights.y * n1 + weights.z * n2) * side;
  vec3 normal = normalize3(interpolated);
  if (max_abs(normal) == 0.0) return;
  point.normal = normal;
  precise vec3 lifted = weights.x * lift_to_curve(point.position, corner0(p), n0 * side) +
                        weights.y * lift_to_curve(point.position, corner1(p), n1 * side) +
                        weights.z * lift_to_curve(point.position, corner2(p), n2 * side);
  point.shadow_position = lifted;
}

// `direction` is the ray's, unit.
ShadingPoint make_shading_point(Ray ray, vec3 direction, Hit hit) {
  Primitive p = load_primitive(hit.primitive);
  SurfaceRecord record = load_surface(hit.primitive);
  SurfacePoint surface = surface_point(ray, p, hit);
  bool is_flipped = dot3(surface.normal, ray.direction) > 0.0;
  ShadingPoint point;
  point.position = surface.position;
  point.geometric_normal = is_flipped ? -surface.normal : surface.normal;
  point.normal = point.geometric_normal;
  point.lift = surface.lift;
  point.shadow_position = surface.position;
  point.color = vec3(1.0);
  point.material = load_material(VIEW.first_index.x + (record.corners_material.w & SURFACE_MATERIAL_MASK));
  precise vec3 weights = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
  if (has(FEATURE_SMOOTH_NORMALS) && (record.corners_material.w & SURFACE_IS_SMOOTH) != 0u) {
    apply_vertex_normals(point, p, record.corners_material.xyz, weights, is_flipped);
  }
  if (has(FEATURE_VERTEX_COLORS) && (record.corners_material.w & SURFACE_IS_COLORED) != 0u) {
    precise vec3 color = weights.x * load_vertex(VIEW.first_index.w + record.corners_material.x) +
                         weights.y * load_vertex(VIEW.first_index.w + record.corners_material.y) +
                         weights.z * load_vertex(VIEW.first_index.w + record.corners_material.z);
    point.color = color;
  }
  point.lobe_shares = vec2(1.0, 0.0);
  if (has(FEATURE_METALLIC_ROUGHNESS)) {
    point.lobe_shares = load_lobe_shares(-dot3(point.normal, direction), point.material.c.x);
  }
  if (has(FEATURE_RAY_LOG)) {
    log_surface(point.position, point.lift, surface.normal, point.normal,
                record.corners_material.w & SURFACE_MATERIAL_MASK);
  }
  return point;
}

// What a source adds where nothing is between.
vec3 unshadowed_contribution(ShadingPoint point, vec3 to_eye, LightRecord light, LightSample sampled) {
  vec3 to_light = normalize3(sampled.direction);
  precise float cosine = dot3(point.normal, to_light);
  if (!(cosine > 0.0 && sampled.strength > 0.0)) return vec3(0.0);

  precise vec3 contribution = contribution_of(point, to_eye, to_light, cosine, light);
  contribution *= sampled.strength;
  return contribution;
}

Ray shadow_ray(ShadingPoint point, LightRecord light) {
  return shadow_ray(lift_off(point.shadow_position, point.geometric_normal, point.lift), light);
}
