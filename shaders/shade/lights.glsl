// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Lights as seen from a surface point. Each kind of promin/kinds/lights.def has a function sample_*.

// A light source as seen from a surface point. If the source has a position, the shadow ray reaches it at t = 1, and
// the ray's tmax is 1. A source at infinity has tmax INFINITY and a direction of any length. `strength` is a factor of
// the source's powers.
struct LightSample {
  vec3 direction;
  float tmax;
  float strength;
};

#include "shade/lights/point.glsl"
#include "shade/lights/directional.glsl"
#include "shade/lights/spot.glsl"
#include "shade/lights/headlight.glsl"
#include "shade/samples.glsl"

// Kinds of lights that may have a size: with FEATURE_SAMPLED_LIGHT, the bits of LightRecord::kind.z.
const uint BALL_KINDS = FEATURE_BIT(FEATURE_POINT_LIGHTS) | FEATURE_BIT(FEATURE_SPOT_LIGHTS);
const uint ROUND_KINDS = BALL_KINDS | FEATURE_BIT(FEATURE_DIRECTIONAL_LIGHTS);
// Other kinds always have one.
const uint FLAT_KINDS = FEATURE_BIT(FEATURE_RECT_LIGHTS) | FEATURE_BIT(FEATURE_DISK_LIGHTS);

bool is_flat(LightRecord light) { return light.kind.x == LIGHT_RECT || light.kind.x == LIGHT_DISK; }
bool is_round(LightRecord light) {
  return ROUND_KINDS != 0u && light.kind.z != 0u && (FLAT_KINDS == 0u || !is_flat(light));
}

#include "shade/lights/ball.glsl"
#include "shade/lights/area.glsl"

// Returns the point of sample_u of a round light.
LightSample sample_round_light(LightRecord light, vec3 position) {
  RoundLight seen = round_light(light, position);
  return point_of_round(light, seen, sample_cone(seen.axis, seen.cap));
}

// Returns the light as seen from `position`; of a light with a size, the point of sample_u.
LightSample sample_light_at(LightRecord light, vec3 position) {
  if (has(FEATURE_SAMPLED_LIGHT)) {
    if (is_round(light)) return sample_round_light(light, position);
  }
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME)            \
  if (has(FEATURE_##FEATURE) && (LIGHT_KIND_COUNT == 1u || light.kind.x == NUMBER)) { \
    return sample_##PREFIX(light, position);                                          \
  }
#include "promin/kinds/lights.def"
  // The pipeline was compiled without lights of this kind, so the light adds nothing.
  return LightSample(vec3(0.0), 0.0, 0.0);
}

// Returns the light as seen from `position`; of a light with a size, the point of the chosen sample (choose_sample).
LightSample sample_light(LightRecord light, vec3 position) {
  if (has(FEATURE_SAMPLED_LIGHT)) sample_u = sample_pair_point();
  return sample_light_at(light, position);
}

// Returns the direction from `origin` to a light source. For a source at infinity it is the same for all origins.
vec3 direction_to_source(vec3 origin, LightRecord light, LightSample sampled) {
  precise vec3 to_source = sampled.tmax < INFINITY ? light.position.xyz - origin : sampled.direction;
  return to_source;
}

// Returns the ray from `origin` to a light source.
Ray shadow_ray(vec3 origin, LightRecord light) {
  LightSample sampled = sample_light(light, origin);
  return make_ray(origin, direction_to_source(origin, light, sampled), 0.0, sampled.tmax);
}

uint source_count() {
  return LIGHT_KIND_COUNT + FEATURE_BIT(FEATURE_SKY_LIGHT) > 0u ? light_count() : 0u;
}
