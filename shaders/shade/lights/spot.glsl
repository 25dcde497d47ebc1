// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A point source that shines into a cone. Its strength is that of KHR_lights_punctual: the square of the clamped slope
// between the cosines of the inner and the outer angle.

LightSample sample_spot(LightRecord light, vec3 position) {
  LightSample result = sample_point(light, position);
  precise float cosine = -dot3(normalize3(result.direction), light.direction.xyz);
  precise float slope = clamp((cosine - light.direction.w) * light.diffuse.w, 0.0, 1.0);
  precise float strength = result.strength * slope * slope;
  result.strength = strength;
  return result;
}
