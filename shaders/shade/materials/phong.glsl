// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Phong's model (docs/model.md, "Phong"). In its MaterialRecord, a holds ambient, b diffuse, c specular and in w the
// exponent, d reflection; b.w and d.w hold the numbers of the texture slots of normals, and of specular and reflection.

vec3 own_light_phong(ShadingPoint point, vec3 direction, bool follows_mirror) {
  precise vec3 own = point.material.a.xyz * point.color * ambient_at(point.normal) + point.material.emissive.xyz;
  return own;
}

vec3 emitted_light_phong(ShadingPoint point) { return point.material.emissive.xyz; }

vec3 contribution_phong(ShadingPoint point, vec3 to_eye, vec3 to_light, float cosine, LightRecord light) {
  // The environment's light is ambient, and has no highlight (sample_sky).
  precise vec3 ambient = INVERSE_PI * point.material.a.xyz;
  vec3 albedo = has(FEATURE_SKY_LIGHT) && is_of_sky(light) ? ambient : point.material.b.xyz;
  precise vec3 contribution = albedo * point.color * light.diffuse.xyz * cosine;
  if (has(FEATURE_SPECULAR) && point.material.c.w > 0.0) {
    precise vec3 mirrored = 2.0 * cosine * point.normal - to_light;
    precise float highlight = dot3(mirrored, to_eye);
    if (highlight > 0.0) {
      // The cosine of unit vectors is at most 1. A larger value is a rounding error.
      contribution +=
          point.material.c.xyz * light.specular.xyz * power(min(highlight, 1.0), point.material.c.w);
    }
  }
  return contribution;
}

vec3 mirror_weight_phong(ShadingPoint point) { return HAS_FACES ? point.glass.mirror : point.material.d.xyz; }

// Returns the roughness with which mirror rays see the environment. Phong mirrors are perfect: their rays see the
// unblurred environment, or the background if there is no environment.
float mirror_roughness_phong(ShadingPoint point) { return perfect_mirror_roughness(); }

vec3 mirror_normal_phong(ShadingPoint point) { return point.normal; }

vec3 albedo_color_phong(ShadingPoint point) {
  precise vec3 color = point.material.b.xyz * point.color;
  return color;
}
