// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A colour that does not depend on light (KHR_materials_unlit). MaterialRecord::a holds the colour.

vec3 own_light_unlit(ShadingPoint point, vec3 direction, bool follows_mirror) {
  precise vec3 own = point.material.a.xyz * point.color + point.material.emissive.xyz;
  return own;
}

// Returns the emitted light, which is all of the material's light.
vec3 emitted_light_unlit(ShadingPoint point) { return own_light_unlit(point, vec3(0.0), false); }

vec3 contribution_unlit(ShadingPoint point, vec3 to_eye, vec3 to_light, float cosine, LightRecord light) {
  return vec3(0.0);
}

vec3 mirror_weight_unlit(ShadingPoint point) { return vec3(0.0); }

float mirror_roughness_unlit(ShadingPoint point) { return NO_ENVIRONMENT; }

vec3 mirror_normal_unlit(ShadingPoint point) { return point.normal; }

vec3 albedo_color_unlit(ShadingPoint point) {
  precise vec3 color = point.material.a.xyz * point.color;
  return color;
}
