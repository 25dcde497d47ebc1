// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What pictures show instead of light (docs/shadings.md): of a camera ray its hit, or what finding it took.

const uint SHADING = (FEATURES >> SHADING_SHIFT) & SHADING_MASK;

// Of 15 bits; never black.
vec3 color_of_hash(uint hash) {
  vec3 parts = vec3((uvec3(hash) >> uvec3(0u, 5u, 10u)) & 31u);
  precise vec3 color = 0.03 + parts * 0.03;
  return color;
}

// From black over violet, red and orange to white: five colours a quarter of the perceived lightness (L*) apart.
vec3 heat_of(uint steps) {
  const vec3 colors[5] =
      vec3[](vec3(0.0), vec3(0.1, 0.0, 0.317), vec3(0.7, 0.04, 0.09), vec3(1.0, 0.375, 0.03), vec3(1.0));
  precise float place = float(min(steps, HEAT_STEPS)) * (4.0 / float(HEAT_STEPS));
  uint below = min(uint(place), 3u);
  precise float share = place - float(below);
  precise vec3 color = (1.0 - share) * colors[below] + share * colors[below + 1u];
  return color;
}

// `normal_and_depth` as of an AOV.
vec3 debug_color(Hit hit, vec4 normal_and_depth) {
  if (SHADING == SHADING_STEPS) return heat_of(step_counts.x + step_counts.y);
  if (hit.primitive == NO_PRIMITIVE) return vec3(0.0);
  if (SHADING == SHADING_UV) {
    precise vec3 weights = vec3(hit.u, hit.v, 1.0 - hit.u - hit.v);
    return weights;
  }
  if (SHADING == SHADING_OBJECT) return color_of_hash(load_primitive(hit.primitive).c.w & 0xFFFFu);
  if (SHADING == SHADING_PRIMITIVE) return color_of_hash(load_primitive(hit.primitive).c.w >> 16);
  if (SHADING == SHADING_DEPTH) {
    float size = frame.tree_bounds.w > 0.0 ? frame.tree_bounds.w : 1.0;
    precise float nearness = size / (size + normal_and_depth.w);
    precise float brightness = nearness * nearness;
    return vec3(brightness);
  }
  precise vec3 color = 0.5 + 0.5 * normal_and_depth.xyz;
  return color;
}
