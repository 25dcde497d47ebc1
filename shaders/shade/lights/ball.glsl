// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Point and spot lights with a radius: balls of radiance I / (pi R^2). Directional lights with an angle: discs of
// uniform radiance at infinity, as the sun is (docs/model.md, "Lights with a size"). Both are seen as cones of
// directions. A ball shines to its inside too.

// A light that is seen as a cone.
struct RoundLight {
  vec3 axis;     // unit
  float cap;     // 1 minus the cosine of half the angle of the cone; 2 inside a ball
  float d2;      // square of the distance of a ball's centre, and of its radius, both scaled
  float r2;
  float unit;    // the scale, a power of two
  float strength;  // radiance of a light of power 1 times the solid angle of the cone
};

RoundLight round_light(LightRecord light, vec3 position) {
  RoundLight seen;
  bool is_ball = BALL_KINDS != 0u && (!has(FEATURE_DIRECTIONAL_LIGHTS) || light.kind.x != LIGHT_DIRECTIONAL);
  precise vec3 to_center = light.position.xyz - position;
  float radius = uintBitsToFloat(light.kind.z);
  // All lengths are scaled by a power of two, so that no square overflows or vanishes.
  seen.unit = is_ball ? power_of_two_inverse(max(max_abs(to_center), radius)) : 1.0;
  precise vec3 to = to_center * seen.unit;
  precise float r = radius * seen.unit;
  precise float r2 = r * r;
  precise float d2 = dot3(to, to);
  seen.d2 = d2;
  seen.r2 = r2;
  bool is_inside = is_ball && d2 <= r2;
  precise float ratio = r2 / d2;
  float sine2 = is_ball ? ratio : radius;
  precise float cosine = sqrt(1.0 - min(sine2, 1.0));
  precise float cap = sine2 / (1.0 + cosine);
  precise float share = 2.0 / (1.0 + cosine);
  seen.cap = is_inside ? 2.0 : cap;
  precise float strength = is_inside ? 4.0 : share;
  seen.axis = is_ball ? (d2 > 0.0 ? normalize3(to) : vec3(0.0, 0.0, 1.0)) : -light.direction.xyz;
  if (has(FEATURE_FALLOFF) && light.kind.y != 0u) {
    precise float distance2 = max(dot3(to_center, to_center), radius * radius);
    precise float ratio2 = distance2 * (light.position.w * light.position.w);
    precise float window = clamp(1.0 - ratio2 * ratio2, 0.0, 1.0) / distance2;
    strength = strength * window;
  }
  seen.strength = strength;
  return seen;
}

// Returns the light's point in a direction of its cone.
LightSample point_of_round(LightRecord light, RoundLight seen, ConeSample cone) {
  if (BALL_KINDS == 0u || (has(FEATURE_DIRECTIONAL_LIGHTS) && light.kind.x == LIGHT_DIRECTIONAL)) {
    return LightSample(cone.direction, INFINITY, seen.strength);
  }
  precise float half_chord = sqrt(max(seen.r2 - seen.d2 * cone.below * (2.0 - cone.below), 0.0));
  precise float along = sqrt(seen.d2) * (1.0 - cone.below);
  bool is_inside = seen.d2 <= seen.r2;
  precise float distance = (is_inside ? along + half_chord : along - half_chord) / seen.unit;
  precise vec3 to_point = distance * cone.direction;
  precise float strength = seen.strength;
  if (has(FEATURE_SPOT_LIGHTS) && light.kind.x == LIGHT_SPOT) {
    // Each point of the ball shines into the same cone.
    precise float from_axis = -dot3(cone.direction, light.direction.xyz);
    precise float slope = clamp((from_axis - light.direction.w) * light.diffuse.w, 0.0, 1.0);
    strength = strength * slope * slope;
  }
  return LightSample(to_point, 1.0, strength);
}
