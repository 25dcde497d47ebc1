// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A colour that does not depend on light (KHR_materials_unlit). MaterialRecord::a holds the colour. If the material
// catches shadows, the point's light is the fraction of light that arrives: 1 minus the light of all sources, plus the
// light of those that are not blocked. a holds the factor of the environment's radiance, b that of a light's power.

bool catches_shadows(ShadingPoint point) {
  return has(FEATURE_SHADOW_CATCHERS) && (flags_of(point.material) & MATERIAL_CATCHES_SHADOWS) != 0u;
}

vec3 own_light_unlit(ShadingPoint point, vec3 direction, bool follows_mirror) {
  precise vec3 own = point.material.a.xyz * point.color + point.material.emissive.xyz;
  if (has(FEATURE_SHADOW_CATCHERS)) own = catches_shadows(point) ? vec3(1.0) : own;
  return own;
}

// Returns the emitted light, which is all of the material's light.
vec3 emitted_light_unlit(ShadingPoint point) { return own_light_unlit(point, vec3(0.0), false); }

vec3 contribution_unlit(ShadingPoint point, vec3 to_eye, vec3 to_light, float cosine, LightRecord light) {
  vec3 contribution = vec3(0.0);
  if (has(FEATURE_SHADOW_CATCHERS)) {
    bool is_sky = has(FEATURE_SKY_LIGHT) && is_of_sky(light);
    bool counts = catches_shadows(point) && (is_sky || light.kind.x == LIGHT_DIRECTIONAL);
    vec3 factor = is_sky ? point.material.a.xyz : point.material.b.xyz;
    precise vec3 caught = factor * light.diffuse.xyz * cosine;
    contribution = counts ? caught : contribution;
  }
  return contribution;
}

vec3 mirror_weight_unlit(ShadingPoint point) { return vec3(0.0); }

float mirror_roughness_unlit(ShadingPoint point) { return NO_ENVIRONMENT; }

vec3 mirror_normal_unlit(ShadingPoint point) { return point.normal; }

vec3 albedo_color_unlit(ShadingPoint point) {
  precise vec3 color = point.material.a.xyz * point.color;
  return color;
}
