// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Point and spot lights with a radius: balls of radiance I / (pi R^2), which are visible only as light
// (docs/model.md, "Lights with a size"). A ball shines to its inside too.

// Returns a point of the ball, seen from `position` with uniform density over its solid angle. strength is 1 / density
// times the radiance of a ball of power 1.
LightSample sample_ball(LightRecord light, vec3 position) {
  precise vec3 to_center = light.position.xyz - position;
  float radius = uintBitsToFloat(light.kind.z);
  // All lengths are scaled by a power of two, so that no square overflows or vanishes.
  float unit = power_of_two_inverse(max(max_abs(to_center), radius));
  precise vec3 to = to_center * unit;
  precise float r = radius * unit;
  precise float r2 = r * r;
  precise float d2 = dot3(to, to);
  bool is_inside = d2 <= r2;
  precise float sine2 = r2 / d2;
  precise float cosine = sqrt(1.0 - min(sine2, 1.0));
  precise float cap = is_inside ? 2.0 : sine2 / (1.0 + cosine);
  precise float share = is_inside ? 4.0 : 2.0 / (1.0 + cosine);
  vec3 axis = d2 > 0.0 ? normalize3(to) : vec3(0.0, 0.0, 1.0);
  ConeSample cone = sample_cone(axis, cap);
  precise float half_chord = sqrt(max(r2 - d2 * cone.below * (2.0 - cone.below), 0.0));
  precise float along = sqrt(d2) * (1.0 - cone.below);
  precise float distance = (is_inside ? along + half_chord : along - half_chord) / unit;
  precise vec3 to_point = distance * cone.direction;
  precise float strength = share;
  if (has(FEATURE_FALLOFF) && light.kind.y != 0u) {
    precise float distance2 = max(dot3(to_center, to_center), radius * radius);
    precise float ratio2 = distance2 * (light.position.w * light.position.w);
    precise float window = clamp(1.0 - ratio2 * ratio2, 0.0, 1.0) / distance2;
    strength = share * window;
  }
  if (has(FEATURE_SPOT_LIGHTS) && light.kind.x == LIGHT_SPOT) {
    // Each point of the ball shines into the same cone.
    precise float from_axis = -dot3(cone.direction, light.direction.xyz);
    precise float slope = clamp((from_axis - light.direction.w) * light.diffuse.w, 0.0, 1.0);
    strength = strength * slope * slope;
  }
  return LightSample(to_point, 1.0, strength);
}
