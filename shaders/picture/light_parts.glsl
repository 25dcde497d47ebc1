// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The parts (PART_*) of a pixel's light, with FEATURE_LIGHT_AOVS: each is a sum over samples, like the whole. Only one
// path of a pixel is traced at a time, so no other lane accesses its records.

uint record_of_part(uint pixel, uint part) {
  uint before = has(FEATURE_AOVS) ? AOV_RECORDS : 1u;
  return (before + part) * window_pixel_count() + pixel;
}

uint record_of_unlit(uint pixel) {
  uint before = (has(FEATURE_AOVS) ? AOV_RECORDS : 1u) + (has(FEATURE_LIGHT_AOVS) ? PART_RECORDS : 0u) +
                (has(FEATURE_SAMPLE_RANGES) ? RANGE_RECORDS : 0u);
  // This condition is separate from the sum, because glslang 12 writes an invalid module for a constant with &&.
  if (has(FEATURE_SAMPLE_IDS) && !has(FEATURE_LISTED_SAMPLES)) before += SAMPLE_IDS / 4u;
  return before * window_pixel_count() + pixel;
}

void add_to_part(uint pixel, uint part, vec3 light) {
  if (all(equal(light, vec3(0.0)))) return;
  uint record = record_of_part(pixel, part);
  precise vec3 sum = load_sum(record).xyz + light;
  pixels[record].xyz = floatBitsToUint(sum);
}

// Adds the radiance that a path's ray receives on a miss.
void add_beyond(Path path, vec3 beyond) {
  if (!has(FEATURE_LIGHT_AOVS)) return;
  uint record = record_of_part(path.pixel, path.part);
  vec4 part = load_sum(record);
  precise vec3 sum = part.xyz + path.weight * beyond;
  // Only surfaces that blend have changed the path's weight. They change all colours equally.
  precise float share = part.w + (path.part == PART_BACKGROUND ? path.weight.x : 0.0);
  pixels[record] = floatBitsToUint(vec4(sum, share));
}

// Adds the light of what is behind a surface that catches shadows, and the fraction of it that is visible.
void add_caught(Path path, vec3 light, vec3 share) {
  if (!has(FEATURE_LIGHT_AOVS)) return;
  uint record = record_of_part(path.pixel, PART_BACKGROUND);
  precise float mean = (share.x + share.y + share.z) * (1.0 / 3.0);
  precise vec4 sum = load_sum(record) + path.weight.x * vec4(light, mean);
  pixels[record] = floatBitsToUint(sum);
}

// Adds the radiance of the path's hit without lights, if the camera sees it.
void add_own_parts(Path path, ShadingPoint point, vec3 own, float coverage) {
  if (path.part != PART_BACKGROUND) return;
  vec3 emitted = emitted_light(point);
  precise vec3 weight = coverage * path.weight;
  // The difference is not negative, because a sum of non-negative numbers is not smaller than either of them.
  precise vec3 emission = weight * emitted;
  precise vec3 indirect = weight * (own - emitted);
  add_to_part(path.pixel, PART_EMISSION, emission);
  add_to_part(path.pixel, PART_INDIRECT, indirect);
}

// Adds the radiance of a point to the part to which the ray that hit it belongs. For a camera ray it adds only the
// light of light sources.
void add_seen_part(uint pixel, uint part, vec3 weight, vec3 own, vec3 seen) {
  bool is_of_camera = part == PART_BACKGROUND;
  precise vec3 light = weight * (is_of_camera ? seen - own : seen);
  add_to_part(pixel, is_of_camera ? PART_DIRECT : part, light);
}

// With FEATURE_UNLIT_SHARE, adds colours that are displayed unchanged to the pixel's unlit light.
void add_to_unlit(uint pixel, vec3 weight, vec3 seen) {
  uint record = record_of_unlit(pixel);
  // The computation is the same as for the whole sum, so that both are equal if nothing else is visible.
  precise vec4 sum = load_sum(record) + vec4(weight * seen, weight.x);
  pixels[record] = floatBitsToUint(sum);
}

// Adds the radiance of a visible point if the point is unlit.
void add_unlit(Path path, uint bounces, ShadingPoint point, vec3 seen, float coverage) {
  if (bounces > 0u || model_of(point) != MATERIAL_UNLIT || catches_shadows(point)) return;
  precise vec3 weight = coverage * path.weight;
  add_to_unlit(path.pixel, weight, seen);
}

// Adds the background that the camera sees, if it is a backdrop.
void add_backdrop(Path path, vec3 seen) {
  if (!has(FEATURE_BACKDROP)) return;
  bvec3 is_shown = bvec3(is_backdrop_shown());
  add_to_unlit(path.pixel, mix(vec3(0.0), path.weight, is_shown), mix(vec3(0.0), seen, is_shown));
}

// True if rays of the stream belong to several parts. If not, all of them are mirror rays.
const uint STREAM_HAS_PARTS =
    FEATURE_BIT(FEATURE_LIGHT_AOVS) & (KEEPS_PROGRESS | FEATURE_BIT(FEATURE_SCATTERING));

// Shift in w of PART_SEEN: the lower bits are the part of the current point; the bits from this one on are the part of
// the path's ray.
const uint PART_OF_RAY_SHIFT = 8u;

void store_part_of_ray(Path path) {
  if (STREAM_HAS_PARTS == 0u) return;
  uint record = record_of_part(path.pixel, PART_SEEN);
  pixels[record].w = (pixels[record].w & ((1u << PART_OF_RAY_SHIFT) - 1u)) | path.part << PART_OF_RAY_SHIFT;
}

// Stores the data of the current point until its light is known, which may take several turns.
void store_seen_part(Path path, vec3 own) {
  if (STREAM_HAS_PARTS == 0u) return;
  pixels[record_of_part(path.pixel, PART_SEEN)] =
      uvec4(floatBitsToUint(own), path.part | path.part << PART_OF_RAY_SHIFT);
}
