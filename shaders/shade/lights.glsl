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
#include "shade/lights/ball.glsl"
#include "shade/lights/sun.glsl"

// Some kinds of lights may have a size: with FEATURE_SAMPLED_LIGHT, the bits of LightRecord::kind.z.
const uint BALL_KINDS = FEATURE_BIT(FEATURE_POINT_LIGHTS) | FEATURE_BIT(FEATURE_SPOT_LIGHTS);

// Returns the chosen point (choose_sample) of a light with a size.
LightSample sample_sized_light(LightRecord light, vec3 position) {
  LightSample sampled;
  if (BALL_KINDS != 0u && (!has(FEATURE_DIRECTIONAL_LIGHTS) || light.kind.x != LIGHT_DIRECTIONAL)) {
    sampled = sample_ball(light, position);
  } else {
    sampled = sample_sun(light);
  }
  return sampled;
}

LightSample sample_light(LightRecord light, vec3 position) {
  if (has(FEATURE_SAMPLED_LIGHT) && light.kind.z != 0u) return sample_sized_light(light, position);
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME)            \
  if (has(FEATURE_##FEATURE) && (LIGHT_KIND_COUNT == 1u || light.kind.x == NUMBER)) { \
    return sample_##PREFIX(light, position);                                          \
  }
#include "promin/kinds/lights.def"
  // The pipeline was compiled without lights of this kind, so the light adds nothing.
  return LightSample(vec3(0.0), 0.0, 0.0);
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
  return LIGHT_KIND_COUNT > 0u ? light_count() : 0u;
}
