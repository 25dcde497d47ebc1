// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Debug views, which pictures show in place of light (docs/shadings.md): properties of a camera ray's hit, or the cost
// of finding it. Each view of promin/kinds/debug_views.def has a function *_color here. It takes the camera ray, its
// hit and `normal_and_depth`, which are those of the AOVs, and is called on a miss as well.

const uint DEBUG_VIEW = (MORE_FEATURES >> DEBUG_VIEW_SHIFT) & DEBUG_VIEW_MASK;

// Returns the colour for a hash of 15 bits. The colour is never black.
vec3 color_of_hash(uint hash) {
  vec3 parts = vec3((uvec3(hash) >> uvec3(0u, 5u, 10u)) & 31u);
  precise vec3 color = 0.03 + parts * 0.03;
  return color;
}

bool is_miss(Hit hit) { return hit.primitive == NO_PRIMITIVE; }

vec3 normals_color(Ray ray, Hit hit, vec4 normal_and_depth) {
  if (is_miss(hit)) return vec3(0.0);
  precise vec3 color = 0.5 + 0.5 * normal_and_depth.xyz;
  return color;
}

vec3 uv_color(Ray ray, Hit hit, vec4 normal_and_depth) {
  if (is_miss(hit)) return vec3(0.0);
  precise vec3 weights = vec3(hit.u, hit.v, 1.0 - hit.u - hit.v);
  return weights;
}

vec3 object_color(Ray ray, Hit hit, vec4 normal_and_depth) {
  return is_miss(hit) ? vec3(0.0) : color_of_hash(object_hash_of(load_primitive_of(hit.primitive, hit.part)));
}

vec3 primitive_color(Ray ray, Hit hit, vec4 normal_and_depth) {
  return is_miss(hit) ? vec3(0.0) : color_of_hash(primitive_hash_of(load_primitive_of(hit.primitive, hit.part)));
}

vec3 depth_color(Ray ray, Hit hit, vec4 normal_and_depth) {
  if (is_miss(hit)) return vec3(0.0);
  float size = VIEW.tree_bounds.w > 0.0 ? VIEW.tree_bounds.w : 1.0;
  precise float nearness = size / (size + normal_and_depth.w);
  precise float brightness = nearness * nearness;
  return vec3(brightness);
}

// Returns a colour of the heat map, which runs from black through violet, red and orange to white. The perceived
// lightness (L*) of the five colours increases in equal steps of a quarter.
vec3 steps_color(Ray ray, Hit hit, vec4 normal_and_depth) {
  const vec3 colors[5] =
      vec3[](vec3(0.0), vec3(0.1, 0.0, 0.317), vec3(0.7, 0.04, 0.09), vec3(1.0, 0.375, 0.03), vec3(1.0));
  uint steps = step_counts.x + step_counts.y;
  precise float place = float(min(steps, HEAT_STEPS)) * (4.0 / float(HEAT_STEPS));
  uint below = min(uint(place), 3u);
  precise float fraction = place - float(below);
  precise vec3 color = (1.0 - fraction) * colors[below] + fraction * colors[below + 1u];
  return color;
}

// The light that is not blocked is added as that of a source (aim_around in camera_stage.comp).
vec3 occlusion_color(Ray ray, Hit hit, vec4 normal_and_depth) { return is_miss(hit) ? vec3(1.0) : vec3(0.0); }

vec3 debug_color(Ray ray, Hit hit, vec4 normal_and_depth) {
#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) \
  if (DEBUG_VIEW == NUMBER) return PREFIX##_color(ray, hit, normal_and_depth);
#include "promin/kinds/debug_views.def"
  return vec3(0.0);
}
