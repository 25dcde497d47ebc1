// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The environment of the scene (docs/model.md, "Environment"): a sky, or uniform ambient light.

// The roughness of a ray that no surface has reflected or refracted. Such a ray sees the background and not the
// environment.
const float NO_ENVIRONMENT = -1.0;

// If all features are compiled in, a scene may have no sky. Its levels then have the side 0, and values fetched from
// them are discarded, because no branch may depend on a uniform.
bvec3 has_no_sky() { return bvec3(VIEW.first_lookup.z == 0u); }

// A prefiltered level of the sky (engine/environment/pack_sky.h): the index of its first entry, and its side in texels.
struct SkyLevel {
  uint first;
  uint side;
};

uint side_of_sky_level(uint shift) {
  uint side = VIEW.first_lookup.z;
  return max(side >> shift, min(side, LEAST_SKY_SIDE));
}

// Returns the position in the map (engine/environment/octahedron.h), 0...1, of a direction of any length.
vec2 octahedral_place(vec3 direction) {
  precise float size = abs(direction.x) + abs(direction.y) + abs(direction.z);
  precise vec2 seen = direction.xz / size;
  precise vec2 folded =
      vec2(times_sign_of(1.0 - abs(seen.y), seen.x), times_sign_of(1.0 - abs(seen.x), seen.y));
  precise vec2 place = 0.5 + 0.5 * (direction.y < 0.0 ? folded : seen);
  return place;
}

// Interpolates between the two texels of an entry.
vec3 mix_sky_entry(uint index, float across) {
  uvec4 words = FETCHES_TEXELS == 0u ? surfaces[index].corners_material : texelFetch(shading_texels, int(index));
  vec2 first = unpackHalf2x16(words.x);
  vec2 middle = unpackHalf2x16(words.y);
  vec2 last = unpackHalf2x16(words.z);
  vec3 left = vec3(first, middle.x);
  vec3 right = vec3(middle.y, last);
  precise vec3 mixed = left + across * (right - left);
  return mixed;
}

vec3 look_up_sky_level(SkyLevel level, vec2 place) {
  // Texels of the border come first, so the middle of texel 0 is at 1.
  precise vec2 texel = place * float(level.side) + 0.5;
  precise vec2 corner = floor(texel);
  precise vec2 offset = texel - corner;
  uint index = level.first + uint(corner.y) * (level.side + 1u) + uint(corner.x);
  vec3 upper = mix_sky_entry(index, offset.x);
  vec3 lower = mix_sky_entry(index + level.side + 1u, offset.x);
  precise vec3 mixed = upper + offset.y * (lower - upper);
  return mixed;
}

// Returns the mean radiance around a direction of any length, over a lobe of this roughness.
vec3 environment_radiance(vec3 direction, float roughness) {
  if (!has(FEATURE_SKY)) return VIEW.ambient.xyz;
  // Finds the last level that is not rougher, and the next level.
  SkyLevel sharper = SkyLevel(0u, 0u);
  SkyLevel rougher = SkyLevel(0u, 0u);
  float sharper_roughness = 0.0;
  float rougher_roughness = 0.0;
  SkyLevel level = SkyLevel(VIEW.first_lookup.y, 0u);
#define PROMIN_SKY_LEVEL(ROUGHNESS, SHIFT)                             \
  level.side = side_of_sky_level(SHIFT);                               \
  if (roughness >= ROUGHNESS) {                                        \
    sharper = level;                                                   \
    sharper_roughness = ROUGHNESS;                                     \
  } else if (rougher_roughness <= sharper_roughness) {                 \
    rougher = level;                                                   \
    rougher_roughness = ROUGHNESS;                                     \
  }                                                                    \
  level.first += (level.side + 1u) * (level.side + 2u);
#include "shade/sky_levels.def"
  vec2 place = octahedral_place(direction);
  vec3 radiance = look_up_sky_level(sharper, place);
  if (roughness > sharper_roughness) {
    precise float share = (roughness - sharper_roughness) / (rougher_roughness - sharper_roughness);
    vec3 blurred = look_up_sky_level(rougher, place);
    precise vec3 mixed = radiance + share * (blurred - radiance);
    radiance = mixed;
  }
  return mix(radiance, VIEW.ambient.xyz, has_no_sky());
}

// Returns the light of all directions, weighted by the cosine to the unit normal and divided by pi. The result is
// clamped to 0, because the few coefficients oscillate around a sun. With FEATURE_SKY_LIGHT this light is that of a
// source.
vec3 ambient_at(vec3 normal) {
  if (has(FEATURE_SKY_LIGHT)) return vec3(0.0);
  if (!has(FEATURE_SKY)) return VIEW.ambient.xyz;
  precise float xy = normal.x * normal.y;
  precise float yz = normal.y * normal.z;
  precise float zx = normal.z * normal.x;
  precise float z2 = 3.0 * normal.z * normal.z - 1.0;
  precise float x2_y2 = normal.x * normal.x - normal.y * normal.y;
  precise vec3 light = VIEW.irradiance[0].xyz + VIEW.irradiance[1].xyz * normal.y +
                       VIEW.irradiance[2].xyz * normal.z + VIEW.irradiance[3].xyz * normal.x +
                       VIEW.irradiance[4].xyz * xy + VIEW.irradiance[5].xyz * yz + VIEW.irradiance[6].xyz * z2 +
                       VIEW.irradiance[7].xyz * zx + VIEW.irradiance[8].xyz * x2_y2;
  return mix(max(light, vec3(0.0)), VIEW.ambient.xyz, has_no_sky());
}

// Returns the roughness at which perfect mirrors see the sky; without a sky they see the background.
float perfect_mirror_roughness() {
  if (!has(FEATURE_SKY)) return NO_ENVIRONMENT;
  return mix(0.0, NO_ENVIRONMENT, has_no_sky().x);
}

// Returns the distance from the upper edge of the picture to a ray's position in it, relative to the picture's height.
// All samples of a pixel use its middle, so that a backdrop has no sampling error.
float height_on_backdrop(vec3 origin, vec3 direction) {
  vec3 rise = CAMERA.backdrop_rise.xyz;
  float rows = CAMERA.backdrop_bottom.w;
  precise float along = max(dot3(direction, CAMERA.look.xyz), SMALLEST_NORMAL);
  precise float by_direction = dot3(direction, rise) / along;
  precise float by_origin = dot3(origin - CAMERA.eye.xyz, rise);
  float up = CAMERA.backdrop_rise.w != 0.0 ? by_origin : by_direction;
  // Rounding may move a sample at the upper edge of a row above the edge.
  precise float row = floor((0.5 - up) * rows + 1.0 / 1024.0);
  precise float height = (clamp(row, 0.0, rows - 1.0) + 0.5) / rows;
  return height;
}

// Returns the backdrop as the camera sees it.
vec3 backdrop_behind(vec3 origin, vec3 direction) {
  vec3 top = VIEW.backdrop_top.xyz;
  precise vec3 color = top + height_on_backdrop(origin, direction) * (VIEW.backdrop_bottom.xyz - top);
  return color;
}

bool is_backdrop_shown() { return VIEW.background.w == SHOWS_BACKDROP; }

// Returns the radiance of a ray that leaves the scene without being reflected or refracted. `is_of_camera` is true if
// it left the camera without mirrors or glass in between.
vec3 radiance_behind(vec3 origin, vec3 direction, bool is_of_camera) {
  vec3 radiance = VIEW.background.xyz;
  if (has(FEATURE_SHOWN_SKY)) {
    radiance = mix(radiance, environment_radiance(direction, 0.0), bvec3(VIEW.background.w == SHOWS_SKY));
  }
  if (has(FEATURE_BACKDROP)) {
    precise vec3 color = (is_of_camera ? 1.0 : VIEW.backdrop_top.w) * backdrop_behind(origin, direction);
    radiance = mix(radiance, color, bvec3(is_backdrop_shown()));
  }
  return radiance;
}

// Returns the radiance of a ray that leaves the scene after mirrors or glass. `roughness` is the largest roughness on
// its way, or NO_ENVIRONMENT.
vec3 radiance_beyond(vec3 origin, vec3 direction, float roughness) {
  if (!SEES_ENVIRONMENT || roughness == NO_ENVIRONMENT) return radiance_behind(origin, direction, false);
  return environment_radiance(direction, roughness);
}
