// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The environment as a source of light that objects block (docs/model.md, "Skies with shadows"). Needs
// FEATURE_SKY_LIGHT.

// The largest distance between the middle of a square of the octahedral map and any of its directions: per side, and
// for all squares.
const float WIDEST_UNIT_SQUARE = 4.25;
const float WIDEST_SQUARE = 1.41421366;
// The usual distance, for which the chances of smooth skies have the least noise, and the share of the largest one.
const float USUAL_UNIT_SQUARE = 2.5;
const float USUAL_SQUARE = 1.05;
const float SHARE_OF_WIDEST = 0.0625;
const float LARGEST_BELOW_ONE = 0.999999940;

// Returns the point of the octahedron |x| + |y| + |z| = 1 for a place in the map (engine/environment/octahedron.h).
vec3 octahedral_point(vec2 place) {
  precise vec2 at = 2.0 * place - 1.0;
  precise float y = 1.0 - abs(at.x) - abs(at.y);
  precise vec2 folded = vec2(times_sign_of(1.0 - abs(at.y), at.x), times_sign_of(1.0 - abs(at.x), at.y));
  vec2 xz = y < 0.0 ? folded : at;
  return vec3(xz.x, y, xz.y);
}

// Returns the mean of max(c, 0) over the numbers c that differ from `cosine` by at most `spread`.
float mean_above_horizon(float cosine, float spread) {
  precise float above = max(cosine + spread, 0.0);
  precise float mean = above * above / (4.0 * spread);
  return cosine >= spread ? cosine : mean;
}

// Returns about the mean of the clamped cosine over a square of this side, from the cosine of its middle. It is 0 only
// if the whole square lies below the horizon.
float cosine_of_square(float cosine, float side) {
  precise float widest_spread = WIDEST_UNIT_SQUARE * side;
  precise float usual_spread = USUAL_UNIT_SQUARE * side;
  float widest = mean_above_horizon(cosine, min(widest_spread, WIDEST_SQUARE));
  precise float least = SHARE_OF_WIDEST * widest;
  return max(mean_above_horizon(cosine, min(usual_spread, USUAL_SQUARE)), least);
}

// A direction of the sky.
struct SkyChoice {
  vec2 place;     // in the map
  float density;  // per solid angle
};

// Chooses a direction of the sky in proportion to its light times its cosine to the normal, nearly: the pyramid has the
// light of the squares of the map, and the cosine of a square comes from that of its middle and from its width. If
// `is_given`, returns the density of the direction at `place` instead. `u` is a point of the unit square.
SkyChoice choose_from_sky(LightRecord light, vec3 normal, vec2 u, bool is_given, vec2 place) {
  uint first = VIEW.first_lookup.y + light.kind.w;
  uint levels = light.kind.y;
  uint square = 0u;
  uint level = 0u;
  vec2 corner = vec2(0.0);
  float side = 1.0;
  float chance = 1.0;
  do {
    if (level < levels) {
      uvec4 words = FETCHES_TEXELS == 0u ? surfaces[first + square].corners_material
                                         : texelFetch(shading_texels, int(first + square));
      vec4 shares = uintBitsToFloat(words);
      side *= 0.5;
      precise vec4 weights;
      [[unroll]] for (uint i = 0u; i < 4u; ++i) {
        precise vec2 middle = corner + side * (vec2(float(i & 1u), float(i >> 1)) + 0.5);
        vec3 point = octahedral_point(middle);
        precise float cosine = dot3(normal, point) / length3(point);
        precise float weight = shares[i] * cosine_of_square(cosine, side);
        weights[i] = weight;
      }
      precise float left = weights.x + weights.z;
      precise float right = weights.y + weights.w;
      precise float total = left + right;
      precise float across = u.x * total;
      bool is_right = is_given ? place.x >= corner.x + side : across >= left && right > 0.0;
      vec2 column = is_right ? weights.yw : weights.xz;
      precise float both = column.x + column.y;
      precise float along = u.y * both;
      bool is_lower = is_given ? place.y >= corner.y + side : along >= column.x && column.y > 0.0;
      float chosen = is_lower ? column.y : column.x;
      precise vec2 rest = vec2(is_right ? across - left : across, is_lower ? along - column.x : along) /
                          max(vec2(both, chosen), vec2(SMALLEST_NORMAL));
      u = clamp(rest, vec2(0.0), vec2(LARGEST_BELOW_ONE));
      precise float scaled = chosen > 0.0 ? chance * (chosen / total) : 0.0;
      chance = scaled;
      corner += side * vec2(is_right ? 1.0 : 0.0, is_lower ? 1.0 : 0.0);
      square = 4u * square + 1u + (is_right ? 1u : 0u) + (is_lower ? 2u : 0u);
      ++level;
    }
  } while (level < levels);
  precise vec2 chosen_place = corner + side * u;
  SkyChoice choice;
  choice.place = is_given ? place : chosen_place;
  // A square of the map of area A has the solid angle 4 A / |p|^3 at the point p of the octahedron.
  vec3 point = octahedral_point(choice.place);
  float size = length3(point);
  precise float density = chance * size * size * size / (4.0 * side * side);
  choice.density = density;
  return choice;
}

// Returns a direction of the half space about the normal, with a density of its cosine / pi.
vec3 choose_by_cosine(vec3 normal, vec2 u) {
  vec3 disc = point_on_disc(u);
  vec3 across;
  vec3 along;
  make_frame(normal, across, along);
  precise vec3 direction = disc.x * across + (disc.y * along + sqrt(1.0 - disc.z) * normal);
  return normalize3(direction);
}

// The shares of the samples at a point.
struct SkyShares {
  float coat;      // the direction is chosen from the lobe of the coat
  float material;  // the direction is chosen from the lobe of the material
  float behind;    // share of all other samples: the direction lights the back
};

// Sets the parts of the lobes that rays from the sky light, and returns the shares of the samples. The rest of a lobe
// is that of the mirror ray. A lobe gets its share of the reflected light. A metal chooses half of its samples by the
// sky.
SkyShares sky_shares(ShadingPoint point) {
  lobe_share = 1.0;
  coat_share = 0.0;
  SkyShares shares = SkyShares(0.0, 0.0, 0.0);
  if (!has(FEATURE_METALLIC_ROUGHNESS) || model_of(point) != MATERIAL_METALLIC_ROUGHNESS) return shares;
  precise float of_lobe = 1.0 - sharpness_of(point);
  lobe_share = of_lobe;
  float scattered = max_abs(albedo_of(point));
  if (has(FEATURE_SHEENS)) {
    precise float with_sheen = scattered + max_abs(point.sheen.color) * min(point.sheen.share, 1.0);
    scattered = with_sheen;
  }
  float from_behind = has(FEATURE_DIFFUSE_TRANSMISSION) ? max_abs(albedo_from_behind(point)) : 0.0;
  precise float reflected = lobe_share * max_abs(reflectance_of(point));
  float below = 1.0;
  float in_coat = 0.0;
  if (is_coated(point)) {
    precise float of_coat = 1.0 - sharpness_of(point.coat.roughness);
    coat_share = of_coat;
    precise float rest = 1.0 - point.coat.weight;
    below = rest;
    precise float by_coat = point.coat.weight * point.coat.share * coat_share;
    in_coat = by_coat;
  }
  precise float diffuse = scattered + from_behind;
  precise float sum = below * (diffuse + 2.0 * reflected) + 2.0 * in_coat;
  precise float by_material = below * reflected / max(sum, SMALLEST_NORMAL);
  precise float by_coat = in_coat / max(sum, SMALLEST_NORMAL);
  precise float behind = from_behind / max(diffuse, SMALLEST_NORMAL);
  return SkyShares(by_coat, by_material, behind);
}

// Returns alpha of the material's lobe as choose_from_lobe() uses it.
float alpha_for_sky(ShadingPoint point) {
  float roughness = point.material.c.x;
  precise float alpha = max(roughness * roughness, LEAST_ALPHA);
  if (has(FEATURE_ANISOTROPY) && point.anisotropy.alphas.x > 0.0) {
    return max(max(point.anisotropy.alphas.x, point.anisotropy.alphas.y), LEAST_ALPHA);
  }
  return alpha;
}

// Returns the direction of the chosen sample as a source at infinity, whose powers are set to the radiance of the
// environment there. The strength is 1 / the density of all ways of choosing the direction (Veach and Guibas, 1995: the
// balance heuristic).
LightSample sample_sky(ShadingPoint point, vec3 to_eye, inout LightRecord light) {
  vec2 u = sample_pair_point();
  SkyShares shares = sky_shares(point);
  precise float by_lobes = shares.coat + shares.material;
  bool is_of_coat = u.x < shares.coat;
  bool is_of_lobe = u.x < by_lobes;
  precise float others = 1.0 - by_lobes;
  precise float middle = by_lobes + others * shares.behind;
  bool is_behind = !is_of_lobe && u.x < middle;
  float begin = is_of_coat ? 0.0 : (is_of_lobe ? shares.coat : (is_behind ? by_lobes : middle));
  precise float by_front = others * (1.0 - shares.behind);
  precise float by_back = others * shares.behind;
  float by_sky = is_behind ? by_back : by_front;
  float width = is_of_coat ? shares.coat : (is_of_lobe ? shares.material : by_sky);
  precise float stretched = (u.x - begin) / max(width, SMALLEST_NORMAL);
  u.x = clamp(stretched, 0.0, LARGEST_BELOW_ONE);

  precise vec3 normal = is_behind ? -point.normal : point.normal;
  float alpha = alpha_for_sky(point);
  precise float coat_alpha = max(point.coat.roughness * point.coat.roughness, LEAST_ALPHA);
  vec3 direction = vec3(0.0);
  if (has(FEATURE_METALLIC_ROUGHNESS)) {
    bool has_coat = has(FEATURE_COATS) && is_of_coat;
    direction = choose_from_lobe(has_coat ? point.coat.normal : point.normal, has_coat ? coat_alpha : alpha, to_eye, u);
  }
  precise float density;
  if (has(FEATURE_SKY)) {
    SkyChoice choice = choose_from_sky(light, normal, u, is_of_lobe, octahedral_place(direction));
    if (!is_of_lobe) direction = normalize3(octahedral_point(choice.place));
    density = by_sky * choice.density;
  } else {
    if (!is_of_lobe) direction = choose_by_cosine(normal, u);
    density = by_sky * INVERSE_PI * max(dot3(normal, direction), 0.0);
  }
  if (has(FEATURE_METALLIC_ROUGHNESS) && !is_behind) {
    if (shares.material > 0.0) density += shares.material * density_of_lobe(point.normal, alpha, to_eye, direction);
    if (has(FEATURE_COATS) && shares.coat > 0.0) {
      density += shares.coat * density_of_lobe(point.coat.normal, coat_alpha, to_eye, direction);
    }
  }
  vec3 radiance = environment_radiance(direction, 0.0);
  light.diffuse.xyz = radiance;
  bool is_phong = has(FEATURE_PHONG) && model_of(point) == MATERIAL_PHONG;
  light.specular.xyz = is_phong ? vec3(0.0) : radiance;
  precise float strength = density > SMALLEST_NORMAL ? 1.0 / density : 0.0;
  return LightSample(direction, INFINITY, strength);
}
