// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A source at a position; with FEATURE_FALLOFF it may fall off as KHR_lights_punctual says:
// clamp(1 - (d / range)^4, 0, 1) / d^2.

LightSample sample_point(LightRecord light, vec3 position) {
  precise vec3 to_light = light.position.xyz - position;
  float strength = 1.0;
  if (has(FEATURE_FALLOFF) && light.kind.y != 0u) {
    precise float distance2 = dot3(to_light, to_light);
    precise float ratio2 = distance2 * (light.position.w * light.position.w);
    precise float window = clamp(1.0 - ratio2 * ratio2, 0.0, 1.0) / distance2;
    strength = window;
  }
  return LightSample(to_light, 1.0, strength);
}
