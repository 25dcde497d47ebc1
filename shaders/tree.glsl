// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The tree of rays that glass makes of a path, with FEATURE_GLASS. A lane follows it depth first, the mirror ray before
// the refracted one, which waits in the stream until the path has come to its end: so the order of a pixel's sum hangs on
// nothing but the tree, at most one ray waits for each bounce, and no path outgrows its place.

// Whether a ray is worth to be followed. In place of others what they would see of the environment is added, of Phong's
// materials nothing.
bool is_followed(inout Path parent, ShadingPoint point, Path child) {
  bool is_phong = has(FEATURE_PHONG) && model_of(point) == MATERIAL_PHONG;
  if (parent.rays < most_tree_rays() && child.bounces <= most_bounces() &&
      max_abs(child.weight) >= least_tree_weight()) {
    ++parent.rays;
    return true;
  }
  if (!is_phong) {
    precise vec3 sum = parent.radiance + child.weight * radiance_beyond(child.direction, child.roughness);
    parent.radiance = sum;
  }
  return false;
}

// The least cosine beyond a face at which a ray begins before it.
const float LEAST_COSINE_BEYOND = 0.125;

// Turns the path into the ray that goes through the point's surface. It begins before that, skips the face, and so
// meets what touches it: the liquid in a glass, the table under it. Where the hit is such a face itself, or the ray runs
// along the surface, it begins behind. `touches`: the hit lies where the path's last ray skipped faces.
void go_beyond(inout Path path, ShadingPoint point, bool touches) {
  precise vec3 weight = path.weight * point.glass.through;
  path.weight = weight;
  float cosine = -dot3(point.glass.direction, point.geometric_normal);
  bool begins_before = !touches && cosine >= LEAST_COSINE_BEYOND;
  path.origin = lift_off(point.position, begins_before ? point.geometric_normal : -point.geometric_normal, point.lift);
  // The point is off its face by its lift at most, and so is the ray's origin.
  precise float skip = 2.0 * point.lift / cosine;
  path.skip = begins_before ? skip : 0.0;
  path.skipped = point.glass.object;
  if (has(FEATURE_TEXTURES)) {
    // What is curved spreads or gathers the cone.
    precise float spread =
        point.glass.bend * path.cone_spread + (point.glass.bend - 1.0) * point.curvature * path.cone_width;
    path.cone_spread = spread;
  }
  path.direction = point.glass.direction;
  path.media = point.glass.beyond;
  path.roughness = max(path.roughness, point.glass.roughness);
  path.kind = LOG_REFRACTION;
  ++path.bounces;
  path.passed_t = -1.0;
  path.passed_order = 0u;
}

// Parts a path at a surface: it becomes its mirror ray, or where there is none the ray beyond; where there are both
// `through` is that one.
void part_path(inout Path path, ShadingPoint point, bool touches, out Path through, out bool is_mirrored,
               out bool is_refracted) {
  through = path;
  go_beyond(through, point, touches);
  Path mirrored = path;
  // Where no bounce is left, own_light has had the environment in the mirror.
  is_mirrored = leads_on(point, path.bounces) && bounce(mirrored, point) && is_followed(path, point, mirrored);
  is_refracted = max_abs(through.weight) > 0.0 && is_followed(path, point, through);
  through.rays = path.rays;
  mirrored.rays = path.rays;
  mirrored.radiance = path.radiance;
  through.radiance = path.radiance;
  if (is_mirrored) {
    path = mirrored;
  } else if (is_refracted) {
    path = through;
  }
}

// Keeps what tells the path from others. `has_seen`: the point that it has reached is still to be added.
void store_glass(uint number, Path path, uint waiting, bool has_seen) {
  pixels[record_of_glass(number) + RECORD_MEDIA] =
      uvec4(path.media, path.rays | (has_seen ? 1u << HAS_SEEN_SHIFT : 0u), waiting | path.kind << KIND_SHIFT);
  pixels[record_of_glass(number) + RECORD_SHADOW_MEDIA].zw = uvec2(floatBitsToUint(path.skip), path.skipped);
}

// Keeps the ray that a path follows when those before it have come to their ends.
void store_waiting(uint number, uint place, Path path) {
  uint record = record_of_waiting(number, place);
  pixels[record] = uvec4(floatBitsToUint(path.origin), floatBitsToUint(path.cone_width));
  pixels[record + 1u] = uvec4(floatBitsToUint(path.direction), floatBitsToUint(path.cone_spread));
  pixels[record + 2u] = uvec4(floatBitsToUint(path.weight), floatBitsToUint(path.roughness));
  pixels[record + 3u] = uvec4(path.media, path.bounces | path.skipped << WAITING_OBJECT_SHIFT, floatBitsToUint(path.skip));
}
