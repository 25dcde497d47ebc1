// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The list of lights: a new one is its file, an #include and a line here.

// A source as a surface point sees it: the shadow ray's direction (not normalised) and its tmax, and a factor to the
// source's powers.
struct LightSample {
  vec3 direction;
  float tmax;
  float strength;
};

#include "lights/point.glsl"
#include "lights/directional.glsl"
#include "lights/spot.glsl"
#include "lights/headlight.glsl"

LightSample sample_light(LightRecord light, vec3 position) {
  if (has(FEATURE_POINT_LIGHTS) && light.kind.x == LIGHT_POINT) return sample_point(light, position);
  if (has(FEATURE_SPOT_LIGHTS) && light.kind.x == LIGHT_SPOT) return sample_spot(light, position);
  if (has(FEATURE_HEADLIGHT) && light.kind.x == LIGHT_HEADLIGHT) return sample_headlight();
  return sample_directional(light);
}
