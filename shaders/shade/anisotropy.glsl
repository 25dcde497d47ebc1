// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Highlights that are stretched along a grain (KHR_materials_anisotropy; docs/model.md, "Metallic-roughness").

// Sets the two alphas of a point with anisotropic highlights, and the roughness and the normal with which it reflects
// the environment.
void stretch(inout ShadingPoint point, vec3 direction) {
  Anisotropy grain = point.anisotropy;
  grain.bent_normal = point.normal;
  point.anisotropy = grain;
  if (!(grain.strength > 0.0)) return;
  MaterialRecord material = point.material;
  float roughness = material.c.x;
  precise float across = roughness * roughness;
  precise float along = across + (1.0 - across) * grain.strength * grain.strength;
  grain.alphas = max(vec2(along, across), vec2(LEAST_ALPHA));
  precise float mean = 0.5 * (along * along + across * across);
  material.c = vec4(sqrt(sqrt(mean)), material.c.yzw);
  point.material = material;
  // The normal is rotated across the grain towards the eye (the extension's notes on image-based lighting).
  vec3 turn = cross3(point.normal, grain.along);
  precise vec3 turned = -direction + dot3(direction, turn) * turn;
  precise float bend = 1.0 - grain.strength * (1.0 - roughness);
  precise float bend2 = bend * bend;
  precise vec3 mixed = turned + (point.normal - turned) * (bend2 * bend2);
  vec3 bent = normalize3(mixed);
  grain.bent_normal = max_abs(bent) == 0.0 ? point.normal : bent;
  point.anisotropy = grain;
}

// Returns the same as facet_scale for a surface with a grain, for a positive cosine to the light. The difference of
// half vector and normal keeps digits that the cosine loses.
float anisotropic_scale(vec3 normal, Anisotropy grain, vec3 h, vec3 to_eye, vec3 to_light, float cosine) {
  vec3 across = cross3(normal, grain.along);
  vec2 a = grain.alphas;
  precise vec3 apart = h - normal;
  precise float q = dot3(apart, apart);
  precise float s2 = q * (1.0 - 0.25 * q);
  precise vec2 slopes = vec2(dot3(grain.along, apart), dot3(across, apart)) / a;
  precise float spread = slopes.x * slopes.x + slopes.y * slopes.y + (1.0 - s2);
  precise float density = INVERSE_PI / (a.x * a.y * spread * spread);
  float v = max(dot3(normal, to_eye), LEAST_COSINE);
  precise vec3 eye = vec3(a * vec2(dot3(grain.along, to_eye), dot3(across, to_eye)), v);
  precise vec3 light = vec3(a * vec2(dot3(grain.along, to_light), dot3(across, to_light)), cosine);
  precise float visibility = 0.5 / (cosine * length3(eye) + v * length3(light));
  precise float scale = cosine * density * visibility;
  return scale;
}
