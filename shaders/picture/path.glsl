// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A path is Whitted's recursion, written as a loop: I = sum of (product of weights so far) * (radiance of a point).
// Where glass splits the path, tree.glsl defines the order. The including file defines `load_sum(record)`, which loads
// the record of a sum with the additions of earlier dispatches and of this lane.

struct Path {
  vec3 origin;     // origin of the next ray
  vec3 direction;  // direction of the next ray, unit
  vec3 weight;     // product of mirror weights so far
  vec3 radiance;   // sum so far
  uint pixel;
  float roughness;  // largest roughness of the surfaces so far, or NO_ENVIRONMENT
  float cone_width;   // width of the pixel's cone, with FEATURE_TEXTURES
  float cone_spread;  // growth of this width per distance
  // The following members need FEATURE_BLENDING:
  uint bounces;  // number of bounces so far
  uint layers;   // number of surfaces passed through so far
  float passed_t;  // if the next ray continues behind a surface: t and order of the surface; otherwise -1
  uint passed_order;
  // The following members need FEATURE_GLASS:
  uvec2 media;  // media that contain the next ray
  uint rays;    // rays of the sample so far, without the camera ray
  float skip;   // t up to which the next ray skips faces of an object (packet.glsl), and the object's hash
  uint skipped;
  uint kind;    // LOG_* of the next ray
  // The following member needs FEATURE_LIGHT_AOVS:
  uint part;  // PART_* that receives the light of the next ray; PART_BACKGROUND for the camera ray
};

// Assigns the path's next ray to a part of the picture, unless it already has one.
void enter_part(inout Path path, uint part) {
  if (has(FEATURE_LIGHT_AOVS) && path.part == PART_BACKGROUND) path.part = part;
}

// True if each path stores its own number of bounces, which may differ from the number of the turn.
const uint KEEPS_PROGRESS = FEATURE_BIT(FEATURE_BLENDING) | FEATURE_BIT(FEATURE_GLASS);

#include "picture/light_parts.glsl"

// Multiplies the path's weight by the medium's absorption on the way to a hit, measured from the surface that the ray
// passed before.
void absorb(inout Path path, Ray ray, Hit hit) {
  if (!has(FEATURE_GLASS)) return;
  precise float way = (hit.t - max(path.passed_t, 0.0)) * length3(ray.direction);
  precise vec3 weight = path.weight * left_after(last_entered(path.media), way);
  path.weight = weight;
}

// Widens the path's cone up to its ray's hit.
void widen_cone(inout Path path, Ray ray, Hit hit) {
  if (!has(FEATURE_TEXTURES)) return;
  precise float width = path.cone_width + path.cone_spread * (hit.t * length3(ray.direction));
  path.cone_width = width;
}

// Adds the radiance of a point with this opacity.
void add_radiance(inout Path path, vec3 seen, float coverage) {
  precise vec3 weight = path.weight;
  if (has(FEATURE_BLENDING)) weight = coverage * weight;
  precise vec3 sum = path.radiance + weight * seen;
  path.radiance = sum;
}

// Returns the opacity of the point. If it is not 1, the ray continues behind the point.
float coverage_of(Path path, ShadingPoint point) {
  if (!has(FEATURE_BLENDING) || (flags_of(point.material) & MATERIAL_BLENDS) == 0u) return 1.0;
  float alpha = clamp(point.material.cover.x, 0.0, 1.0);
  precise vec3 behind = (1.0 - alpha) * path.weight;
  return path.layers < MOST_LAYERS && max_abs(behind) >= LEAST_SHARE_BEHIND ? alpha : 1.0;
}

// Turns the path into the continuation of its ray behind the hit. Its direction is the traced one, which is not of unit
// length.
void go_through(inout Path path, Ray ray, float t, uint order, float coverage) {
  precise vec3 weight = (1.0 - coverage) * path.weight;
  path.weight = weight;
  path.origin = ray.origin;
  path.direction = ray.direction;
  path.kind = LOG_THROUGH;
  path.passed_t = t;
  path.passed_order = order;
  ++path.layers;
}

// Returns whether the path continues with a mirror ray at the point, or with a scattered one. `bounce` is the number of
// this bounce.
bool leads_on(ShadingPoint point, uint bounce) {
  if (has(FEATURE_SCATTERING)) return bounce < most_bounces();
  return has(FEATURE_MIRRORS) && bounce < most_bounces() && max_abs(mirror_weight(point)) > 0.0;
}

// Turns the path into its mirror ray, but does not change its weight.
void turn_back(inout Path path, ShadingPoint point) {
  path.origin = lift_off(point.position, point.geometric_normal, point.lift);
  if (has(FEATURE_TEXTURES)) {
    // Curvature widens the cone, also behind a focus.
    precise float facing = max(-dot3(mirror_normal(point), path.direction), 1.0 / 64.0);
    precise float spread = path.cone_spread + 2.0 * point.curvature * path.cone_width / facing;
    path.cone_spread = spread;
  }
  path.direction = reflect_direction(path.direction, mirror_normal(point), point.geometric_normal);
  ++path.bounces;
  path.passed_t = -1.0;
  path.passed_order = 0u;
  path.kind = LOG_REFLECTION;
  enter_part(path, PART_REFLECTION);
  path.skip = 0.0;
  if (SEES_ENVIRONMENT) path.roughness = max(path.roughness, mirror_roughness(point));
}

// Turns the path into its mirror ray. Returns false if the mirror ray would add nothing.
bool bounce(inout Path path, ShadingPoint point) {
  precise vec3 weight = path.weight * mirror_weight(point);
  path.weight = weight;
  if (!(max_abs(weight) > 0.0)) return false;
  turn_back(path, point);
  return true;
}

// Stores the data of a path that may pass through surfaces in the stream.
void store_passed(uint number, Path path) {
  if (KEEPS_PROGRESS == 0u) return;
  pixels[record_of_weight(number, 0u)].w = floatBitsToUint(path.passed_t);
  pixels[record_of_weight(number, 1u)].w = path.passed_order;
  pixels[record_of_path(number) + RECORD_SHADOW_ORIGIN].w = path.layers << LAYERS_SHIFT | path.bounces;
}

uint record_of_range(uint pixel, uint end) {
  uint before = (has(FEATURE_AOVS) ? AOV_RECORDS : 1u) + (has(FEATURE_LIGHT_AOVS) ? PART_RECORDS : 0u) +
                (has(FEATURE_SAMPLE_IDS) ? SAMPLE_IDS / 4u : 0u);
  return (before + end) * window_pixel_count() + pixel;
}

void extend_range(uint pixel, vec3 sampled) {
  uint least = record_of_range(pixel, RANGE_LEAST);
  uint largest = record_of_range(pixel, RANGE_LARGEST);
  bool is_first = sample_at_hand() == 0u;
  vec3 lo = is_first ? vec3(INFINITY) : load_sum(least).xyz;
  vec3 hi = is_first ? vec3(-INFINITY) : load_sum(largest).xyz;
  // Most samples lie within the range, so the comparison saves stores.
  if (is_first || any(lessThan(sampled, lo))) pixels[least].xyz = floatBitsToUint(min(lo, sampled));
  if (is_first || any(greaterThan(sampled, hi))) pixels[largest].xyz = floatBitsToUint(max(hi, sampled));
}

// Adds the path's radiance to its pixel as one sample. The first sample begins the sum. CPU drivers execute the stores
// of a branch even if no lane takes it, so a branch that clears the sums for the first sample would slow down every
// sample.
void finish_path(Path path) {
  precise vec3 sum = path.radiance;
  if (!has(FEATURE_LISTED_SAMPLES) && sample_at_hand() > 0u) sum += load_sum(path.pixel).xyz;
  pixels[path.pixel].xyz = floatBitsToUint(sum);
  if (has(FEATURE_SAMPLE_RANGES)) extend_range(path.pixel, path.radiance);
}
