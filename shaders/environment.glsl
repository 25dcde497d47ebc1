// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What surrounds the scene (docs/model.md, "Environment"): a sky, or else the same ambient light from everywhere.

// Of rays that were never deflected by a surface with an environment: they see the background.
const float NO_ENVIRONMENT = -1.0;

// The mean radiance about a direction, over a lobe of this roughness.
vec3 environment_radiance(vec3 direction, float roughness) {
  return VIEW.ambient.xyz;
}

// The light of all directions over pi, weighted by the cosine to the normal.
vec3 ambient_at(vec3 normal) {
  return VIEW.ambient.xyz;
}

// What a ray brings that leaves the scene; `roughness` is the largest of those on its way, or NO_ENVIRONMENT.
vec3 radiance_beyond(vec3 direction, float roughness) {
  if (!SEES_ENVIRONMENT || roughness == NO_ENVIRONMENT) return VIEW.background.xyz;
  return environment_radiance(direction, roughness);
}
