// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Scattered rays, with FEATURE_SCATTERING (docs/model.md, "Scattered light"). A path continues in one direction, in
// which a lobe of the surface scatters light to the eye. The chance of a lobe is proportional to the light that it
// reflects, and the density of a direction nearly to the lobe's value. Therefore the weight of a path is bounded.

// The state of a path, beside that of Path. It is in RECORD_SAMPLE; here are the values of the camera's ray.
float environment_share = 1.0;  // fraction of the environment's light that the path's ray adds if it hits nothing; the
                                // rest is the light of a source
bool is_diffused = false;       // true after a diffuse surface

// Returns the part of the light of a source that the path's ray adds.
vec3 share_of_ray(vec3 light) {
  precise vec3 share = environment_share * light;
  return share;
}

// The first of the pairs of dimensions that choose directions. The pairs of sources have smaller numbers.
const uint FIRST_DIRECTION_PAIR = 0x40000000u;
// The roughness that surfaces have at least after a diffuse one.
const float ROUGHNESS_AFTER_DIFFUSION = 0.55;

// Sets whether the path has hit a diffuse surface, and the least roughness of the surface that its ray hits.
void set_diffused(bool is_after_diffusion) {
  is_diffused = is_after_diffusion;
  least_roughness = is_diffused ? ROUGHNESS_AFTER_DIFFUSION : 0.0;
}

// Sets the state of a path of the stream.
void load_scattering(uint number) {
  uvec4 state = floatBitsToUint(load_record(record_of_path(number) + RECORD_SAMPLE));
  sample_key = state.x;
  sample_number = state.y;
  environment_share = uintBitsToFloat(state.z);
  set_diffused(state.w != 0u);
}

void store_scattering(uint number) {
  pixels[record_of_path(number) + RECORD_SAMPLE] =
      uvec4(sample_key, sample_number, floatBitsToUint(environment_share), is_diffused ? 1u : 0u);
}

// With TRACES_SHADOWS a path has these records, which fill a cache line.
const uint SCATTERED_ORIGIN = 0u;     // Its w is the pixel.
const uint SCATTERED_DIRECTION = 1u;  // Its w is the number of the sample. Bit SEES_BLACK_SHIFT is NO_ENVIRONMENT.
const uint SCATTERED_WEIGHT = 2u;     // Its w is environment_share. The sign is negative if is_diffused.
const uint SCATTERED_RADIANCE = 3u;   // Its w is the key of the sample.
const uint SCATTERED_CONE = 4u;       // With FEATURE_TEXTURES, x and y are width and spread of the path's cone.
const uint SEES_BLACK_SHIFT = 31u;

// Stores a path whose next ray is that of scatter().
void store_scattered(uint number, Path path) {
  uint record = record_of_path(number);
  uint sees_black = path.roughness == NO_ENVIRONMENT ? 1u : 0u;
  uint sign_bit = is_diffused ? 0x80000000u : 0u;
  pixels[record + SCATTERED_ORIGIN] = uvec4(floatBitsToUint(path.origin), path.pixel);
  pixels[record + SCATTERED_DIRECTION] =
      uvec4(floatBitsToUint(path.direction), sample_number | sees_black << SEES_BLACK_SHIFT);
  pixels[record + SCATTERED_WEIGHT] =
      uvec4(floatBitsToUint(path.weight), floatBitsToUint(environment_share) | sign_bit);
  pixels[record + SCATTERED_RADIANCE] = uvec4(floatBitsToUint(path.radiance), sample_key);
  if (has(FEATURE_TEXTURES)) {
    pixels[record + SCATTERED_CONE].xy = floatBitsToUint(vec2(path.cone_width, path.cone_spread));
  }
}

// Sets a path of the stream and its state.
void load_scattered(uint number, out Path path) {
  uint record = record_of_path(number);
  vec4 origin = load_record(record + SCATTERED_ORIGIN);
  vec4 direction = load_record(record + SCATTERED_DIRECTION);
  vec4 weight = load_record(record + SCATTERED_WEIGHT);
  vec4 radiance = load_record(record + SCATTERED_RADIANCE);
  uint bits = floatBitsToUint(direction.w);
  path.origin = origin.xyz;
  path.pixel = floatBitsToUint(origin.w);
  path.direction = direction.xyz;
  path.roughness = (bits >> SEES_BLACK_SHIFT) != 0u ? NO_ENVIRONMENT : 0.0;
  path.weight = weight.xyz;
  path.radiance = radiance.xyz;
  path.media = uvec2(NO_MEDIUM);
  if (has(FEATURE_TEXTURES)) {
    vec4 cone = load_record(record + SCATTERED_CONE);
    path.cone_width = cone.x;
    path.cone_spread = cone.y;
  }
  sample_key = floatBitsToUint(radiance.w);
  sample_number = bits & ((1u << SEES_BLACK_SHIFT) - 1u);
  environment_share = abs(weight.w);
  set_diffused((floatBitsToUint(weight.w) & 0x80000000u) != 0u);
}

// The lobes of a surface, in the order in which they are chosen.
const uint LOBE_DIFFUSE = 0u;
const uint LOBE_BEHIND = 1u;  // light that the surface scatters through itself
const uint LOBE_MIRROR = 2u;  // facets of the material, or Phong's mirror
const uint LOBE_COAT = 3u;
const uint LOBE_GLASS = 4u;

// The fractions of light from all directions that the lobes send to the eye. Functions here return structs as out
// parameters for the reason at make_shading_point().
struct Lobes {
  vec3 diffuse;
  vec3 behind;
  vec3 mirror;
  float coat;
  vec3 glass;
};

void find_lobes(ShadingPoint point, out Lobes lobes) {
  lobes = Lobes(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, has(FEATURE_GLASS) ? point.glass.through : vec3(0.0));
  if (has(FEATURE_PHONG) && model_of(point) == MATERIAL_PHONG) {
    lobes.diffuse = albedo_color_phong(point);
    lobes.mirror = mirror_weight_phong(point);
  }
  if (!has(FEATURE_METALLIC_ROUGHNESS) || model_of(point) != MATERIAL_METALLIC_ROUGHNESS) return;
  precise float below = 1.0;
  if (is_coated(point)) {
    below = 1.0 - point.coat.weight;
    precise float coat = point.coat.weight * point.coat.share;
    lobes.coat = coat;
  }
  precise vec3 mirror = below * reflectance_of(point);
  precise vec3 diffuse = below * albedo_of(point);
  lobes.mirror = mirror;
  lobes.diffuse = diffuse;
  if (has(FEATURE_SHEENS)) {
    precise vec3 with_sheen = diffuse + below * min(point.sheen.share, 1.0) * point.sheen.color;
    lobes.diffuse = with_sheen;
  }
  if (has(FEATURE_DIFFUSE_TRANSMISSION)) {
    precise vec3 behind = below * albedo_from_behind(point);
    if (has(FEATURE_SHEENS)) behind *= left_below_sheen(point.sheen, point.sheen.share);
    lobes.behind = behind;
  }
}

// The facets of a lobe, in a frame about its normal.
struct Facets {
  vec3 across;
  vec3 along;
  vec3 normal;
  vec2 alphas;
};

void make_facets(ShadingPoint point, bool is_of_coat, out Facets facets) {
  facets.normal = has(FEATURE_COATS) && is_of_coat ? point.coat.normal : point.normal;
  make_frame(facets.normal, facets.across, facets.along);
  float roughness = has(FEATURE_COATS) && is_of_coat ? point.coat.roughness : point.material.c.x;
  precise float alpha = roughness * roughness;
  facets.alphas = vec2(alpha);
  if (has(FEATURE_ANISOTROPY) && !is_of_coat && point.anisotropy.alphas.x > 0.0) {
    facets.alphas = point.anisotropy.alphas;
    facets.across = point.anisotropy.along;
    facets.along = cross3(point.normal, point.anisotropy.along);
  }
}

// Returns the length of a direction at this cosine to the normal after its parts along the surface have been multiplied
// by the alphas.
float stretched_length(Facets facets, vec3 direction, float cosine) {
  precise vec3 stretched =
      vec3(facets.alphas * vec2(dot3(direction, facets.across), dot3(direction, facets.along)), cosine);
  return length3(stretched);
}

// Returns Smith's G2 / G1: the weight of a direction that is chosen by visible normals, without Fresnel's factor.
float weight_of_direction(Facets facets, vec3 to_eye, vec3 direction) {
  float v = max(dot3(to_eye, facets.normal), LEAST_COSINE);
  float l = max(dot3(direction, facets.normal), 0.0);
  float v_length = stretched_length(facets, to_eye, v);
  precise float both = l * v_length + v * stretched_length(facets, direction, l);
  precise float weight = l * (v + v_length) / both;
  return weight;
}

// A direction in which a surface scatters a path.
struct Scattered {
  vec3 direction;           // unit
  vec3 weight;              // the light that the lobe sends to the eye, divided by the density of the direction
  float environment_share;  // see above
};

// Chooses a direction by its cosine to the normal. Directions below the surface have no weight.
void scatter_diffusely(ShadingPoint point, vec3 to_eye, vec2 u, bool is_behind, Lobes lobes, out Scattered scattered) {
  scattered.direction = choose_by_cosine(is_behind ? -point.normal : point.normal, u);
  scattered.weight = is_behind ? lobes.behind : lobes.diffuse;
  scattered.environment_share = 0.0;
  if (has(FEATURE_SHEENS) && !is_behind && max_abs(point.sheen.color) > 0.0) {
    precise float cosine = dot3(point.normal, scattered.direction);
    precise float density = max(INVERSE_PI * cosine, SMALLEST_NORMAL);
    precise vec3 half_vector = to_eye + scattered.direction;
    LightRecord uniform_light;
    uniform_light.specular = vec4(1.0);
    precise vec3 below_sheen = density * albedo_of(point);
    vec3 sent = contribution_with_sheen(point, normalize3(half_vector), to_eye, cosine, uniform_light, below_sheen);
    precise vec3 weight = (is_coated(point) ? 1.0 - point.coat.weight : 1.0) * sent / density;
    scattered.weight = weight;
  }
  float outside = dot3(scattered.direction, point.geometric_normal);
  if ((is_behind ? -outside : outside) <= 0.0) scattered.weight = vec3(0.0);
}

// Chooses a direction by the visible normals of facets. Surfaces without visible facets are perfect mirrors.
void scatter_by_lobe(ShadingPoint point, vec3 direction, vec2 u, bool is_of_coat, Lobes lobes,
                     out Scattered scattered) {
  scattered.weight = is_of_coat ? vec3(lobes.coat) : lobes.mirror;
  scattered.environment_share = 1.0;
  vec3 h = point.normal;
  if (has(FEATURE_METALLIC_ROUGHNESS) && model_of(point) == MATERIAL_METALLIC_ROUGHNESS) {
    vec3 to_eye = -direction;
    Facets facets;
    make_facets(point, is_of_coat, facets);
    bool is_perfect = max(facets.alphas.x, facets.alphas.y) <= LEAST_ALPHA;
    vec3 facet = choose_facet(facets.across, facets.along, facets.normal, facets.alphas, to_eye, u);
    float facing = dot3(to_eye, facet);
    precise vec3 mirrored = 2.0 * facing * facet - to_eye;
    vec3 chosen = normalize3(mirrored);
    vec3 reflected = vec3(point.coat.weight);
    if (!is_of_coat) {
      reflected = reflectance_of_facets(point, clamp(facing, 0.0, 1.0));
      if (has(FEATURE_SHEENS)) {
        float from_light = load_sheen_share(max(dot3(point.normal, chosen), LEAST_COSINE), point.sheen.roughness);
        reflected *= left_below_sheen(point.sheen, max(point.sheen.share, from_light));
      }
      if (is_coated(point)) reflected *= 1.0 - point.coat.weight;
    }
    precise vec3 weight = weight_of_direction(facets, to_eye, chosen) * reflected;
    if (!is_perfect) scattered.weight = weight;
    h = is_perfect ? facets.normal : facet;
    scattered.environment_share = is_of_coat ? sharpness_of(point.coat.roughness) : sharpness_of(point);
  }
  scattered.direction = reflect_direction(direction, h, point.geometric_normal);
}

// Sets the direction of light through glass. Rough glass refracts at a facet; if this facet reflects totally, the
// surface's own normal is used.
void roughen_glass(inout ShadingPoint point, Path path, vec2 u) {
  Glass glass = point.glass;
  precise float alpha = max(glass.roughness, 0.0) * max(glass.roughness, 0.0);
  if (is_diffused || alpha <= LEAST_ALPHA) return;
  vec3 to_eye = -path.direction;
  Facets facets;
  make_facets(point, false, facets);
  facets.alphas = vec2(alpha);
  vec3 h = choose_facet(facets.across, facets.along, facets.normal, facets.alphas, to_eye, u);
  uint number = glass_number(point.material);
  vec3 refracted;
  bool goes_through;
  if ((load_glass(number).bits.x & GLASS_IS_THIN) != 0u) {
    // The lobe of a wall is that of its reflection, on the other side.
    precise vec3 mirrored = 2.0 * dot3(to_eye, h) * h - to_eye;
    precise vec3 turned = mirrored - 2.0 * dot3(mirrored, point.normal) * point.normal;
    refracted = normalize3(turned);
    goes_through = true;
  } else {
    Face face;
    make_face(number, false, (glass.object & SKIPS_EXIT) != 0u, path.media, color_of(path.weight), face);
    goes_through = refract_about(h, path.direction, face, refracted);
  }
  if (goes_through && dot3(refracted, point.geometric_normal) < 0.0) glass.direction = refracted;
  point.glass = glass;
}

// Turns the path into the ray in one of whose directions the point scatters light. `step` is the number of the path's
// ray in its sample; `touches` is an argument of go_beyond(). Returns false if the ray would add nothing.
bool scatter(inout Path path, ShadingPoint point, uint step, bool touches) {
  Lobes lobes;
  find_lobes(point, lobes);
  precise float end_of_diffuse = max_abs(lobes.diffuse);
  precise float end_of_behind = end_of_diffuse + max_abs(lobes.behind);
  precise float end_of_mirror = end_of_behind + max_abs(lobes.mirror);
  precise float end_of_coat = end_of_mirror + lobes.coat;
  precise float sum = end_of_coat + max_abs(lobes.glass);
  choose_sample(uvec2(sample_key, sample_number), FIRST_DIRECTION_PAIR + step);
  vec2 u = sample_pair_point();
  precise float at = u.x * sum;
  uint lobe = uint(at >= end_of_diffuse) + uint(at >= end_of_behind) + uint(at >= end_of_mirror) +
              uint(at >= end_of_coat);
  float begin = lobe == LOBE_DIFFUSE  ? 0.0
                : lobe == LOBE_BEHIND ? end_of_diffuse
                : lobe == LOBE_MIRROR ? end_of_behind
                : lobe == LOBE_COAT   ? end_of_mirror
                                      : end_of_coat;
  float end = lobe == LOBE_DIFFUSE  ? end_of_diffuse
              : lobe == LOBE_BEHIND ? end_of_behind
              : lobe == LOBE_MIRROR ? end_of_mirror
              : lobe == LOBE_COAT   ? end_of_coat
                                    : sum;
  precise float width = end - begin;
  if (!(width > 0.0)) return false;
  precise float stretched = (at - begin) / width;
  u.x = clamp(stretched, 0.0, LARGEST_BELOW_ONE);
  precise float inverse_chance = sum / width;

  if (has(FEATURE_GLASS) && lobe == LOBE_GLASS) {
    roughen_glass(point, path, u);
    go_beyond(path, point, touches);
    precise vec3 weight = path.weight * inverse_chance;
    path.weight = weight;
    path.roughness = min(path.roughness, 0.0);
    environment_share = is_diffused ? environment_share : 1.0;
    return max_abs(weight) > 0.0;
  }

  bool is_of_coat = lobe == LOBE_COAT;
  bool is_of_lobe = lobe == LOBE_MIRROR || is_of_coat;
  bool is_behind = lobe == LOBE_BEHIND;
  Scattered scattered;
  if (is_of_lobe) {
    scatter_by_lobe(point, path.direction, u, is_of_coat, lobes, scattered);
  } else {
    scatter_diffusely(point, -path.direction, u, is_behind, lobes, scattered);
  }
  precise vec3 weight = path.weight * (inverse_chance * scattered.weight);
  path.weight = weight;
  if (!(max_abs(weight) > 0.0)) return false;
  enter_part(path, is_of_lobe ? PART_REFLECTION : PART_INDIRECT);
  turn_back(path, point);
  path.direction = scattered.direction;
  path.roughness = min(path.roughness, 0.0);
  if (!is_of_lobe) path.origin = is_behind ? shadow_origin_behind(point) : shadow_origin(point);
  environment_share = scattered.environment_share;
  is_diffused = is_diffused || !is_of_lobe;
  return true;
}
