// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The tree of rays into which glass splits a path, with FEATURE_GLASS. A lane follows it depth first. The mirror ray
// comes before the refracted one, which waits in the stream until the path has ended. The order of a pixel's sum
// therefore depends only on the tree, at most one ray waits for each bounce, and no path exceeds its space.

// Returns whether a ray is worth tracing. If it is not, adds the environment that the ray would see; for Phong
// materials nothing is added.
bool is_followed(inout Path parent, ShadingPoint point, Path child) {
  bool is_phong = has(FEATURE_PHONG) && model_of(point) == MATERIAL_PHONG;
  if (parent.rays < most_tree_rays() && child.bounces <= most_bounces() &&
      max_abs(child.weight) >= least_tree_weight()) {
    ++parent.rays;
    return true;
  }
  if (!is_phong) {
    vec3 beyond = radiance_beyond(child.origin, child.direction, child.roughness);
    precise vec3 sum = parent.radiance + child.weight * beyond;
    parent.radiance = sum;
    add_beyond(child, beyond);
  }
  return false;
}

// The smallest cosine beyond a face for which a ray starts before the face.
const float LEAST_COSINE_BEYOND = 0.125;

// Turns the path into the ray that passes through the point's surface. The ray starts before the surface and skips the
// face, so it hits objects that touch the face: the liquid in a glass, or the table under it. If the hit is such a face
// itself, or the ray runs along the surface, the ray starts behind it. `touches` is true if the hit lies in the range
// in which the path's last ray skipped faces.
void go_beyond(inout Path path, ShadingPoint point, bool touches) {
  precise vec3 weight = path.weight * point.glass.through;
  path.weight = weight;
  float cosine = -dot3(point.glass.direction, point.geometric_normal);
  bool begins_before = !touches && cosine >= LEAST_COSINE_BEYOND;
  path.origin = lift_off(point.position, begins_before ? point.geometric_normal : -point.geometric_normal, point.lift);
  // The distance of the point from its face is at most its lift. The same holds for the ray's origin.
  precise float skip = 2.0 * point.lift / cosine;
  path.skip = begins_before ? skip : 0.0;
  path.skipped = point.glass.object;
  if (has(FEATURE_TEXTURES)) {
    // Curvature widens or narrows the cone.
    precise float spread =
        point.glass.bend * path.cone_spread + (point.glass.bend - 1.0) * point.curvature * path.cone_width;
    path.cone_spread = spread;
  }
  path.direction = point.glass.direction;
  path.media = point.glass.beyond;
  path.roughness = max(path.roughness, point.glass.roughness);
  path.kind = LOG_REFRACTION;
  enter_part(path, PART_TRANSMISSION);
  ++path.bounces;
  path.passed_t = -1.0;
  path.passed_order = 0u;
}

// Sets the face with the index of refraction for light of this colour.
void make_colored_face(Path path, ShadingPoint point, uint color, out Face face) {
  make_face(glass_number(point.material), false, (point.glass.object & SKIPS_EXIT) != 0u, path.media, color, face);
}

// Returns the colours of light through the face, as bits, if the face separates them; otherwise 0.
uint parted_colors(Path path, ShadingPoint point) {
  if (!has(FEATURE_DISPERSION)) return 0u;
  if (count_colors(path.weight) < 2u || point.glass.bend == 1.0) return 0u;
  Face red;
  Face blue;
  make_colored_face(path, point, RED, red);
  make_colored_face(path, point, BLUE, blue);
  precise vec3 weight = path.weight * point.glass.through;
  bool is_parted = red.from != blue.from || red.to != blue.to;
  return is_parted ? uint(weight.x > 0.0) | uint(weight.y > 0.0) << 1 | uint(weight.z > 0.0) << 2 : 0u;
}

// Turns the path into the ray of one colour that passes through the point's surface. If this colour is reflected
// totally while others are not, the ray is the reflected one.
void send_color(inout Path path, ShadingPoint point, bool touches, uint color) {
  precise vec3 kept = point.glass.through * vec3(color == RED, color == GREEN, color == BLUE);
  Face face;
  make_colored_face(path, point, color, face);
  vec3 refracted;
  if (refract_at(point, path.direction, face, refracted)) {
    Glass glass = point.glass;
    precise float bend = face.from / face.to;
    glass.through = kept;
    glass.bend = bend;
    glass.direction = refracted;
    point.glass = glass;
    go_beyond(path, point, touches);
  } else {
    precise vec3 weight = path.weight * kept;
    path.weight = weight;
    enter_part(path, PART_TRANSMISSION);
    turn_back(path, point);
    path.kind = LOG_REFRACTION;
  }
}

// The rays of a path that are traced after a surface: its mirror ray, and the ray beyond the surface or, in its place,
// one ray of each colour.
struct Children {
  bool is_mirrored;
  bool is_refracted;
  uint colors;   // bits of the colours, by their numbers
  Path through;  // the refracted ray, or the path from which the rays of colours are made
};

uint count_refracted(Children children) { return children.is_refracted ? 1u : uint(bitCount(children.colors)); }

// Splits a path at a surface. The path becomes the first of its children. Without children it does not change.
void part_path(inout Path path, ShadingPoint point, bool touches, out Children children) {
  Path parent = path;
  Path next = path;
  bool is_mirrored = leads_on(point, path.bounces) && bounce(next, point) && is_followed(path, point, next);
  bool has_next = is_mirrored;
  bool is_refracted = false;
  uint colors = 0u;
  Path through = parent;
  uint parted = parted_colors(parent, point);
  if (parted != 0u) {
    for (uint left = parted; left != 0u; left &= left - 1u) {
      uint color = uint(findLSB(left));
      Path child = parent;
      send_color(child, point, touches, color);
      if (!is_followed(path, point, child)) continue;
      colors |= 1u << color;
      if (!has_next) next = child;
      has_next = true;
    }
  } else {
    go_beyond(through, point, touches);
    is_refracted = max_abs(through.weight) > 0.0 && is_followed(path, point, through);
    if (is_refracted && !has_next) next = through;
    has_next = has_next || is_refracted;
  }
  through.rays = path.rays;
  through.radiance = path.radiance;
  next.rays = path.rays;
  next.radiance = path.radiance;
  if (has_next) path = next;
  children.is_mirrored = is_mirrored;
  children.is_refracted = is_refracted;
  children.colors = colors;
  children.through = through;
}

// Stores the data of the path. `has_seen` is true if the light of its current point has not been added yet.
void store_glass(uint number, Path path, uint waiting, bool has_seen) {
  pixels[record_of_glass(number) + RECORD_MEDIA] =
      uvec4(path.media, path.rays | (has_seen ? 1u << HAS_SEEN_SHIFT : 0u), waiting | path.kind << KIND_SHIFT);
  pixels[record_of_glass(number) + RECORD_SHADOW_MEDIA].zw = uvec2(floatBitsToUint(path.skip), path.skipped);
}

// Stores a ray that the path follows after all rays before it have ended.
void store_waiting(uint number, uint place, Path path) {
  uint record = record_of_waiting(number, place);
  pixels[record] = uvec4(floatBitsToUint(path.origin), floatBitsToUint(path.cone_width));
  pixels[record + 1u] = uvec4(floatBitsToUint(path.direction), floatBitsToUint(path.cone_spread));
  pixels[record + 2u] = uvec4(floatBitsToUint(path.weight), floatBitsToUint(path.roughness));
  uint progress = path.bounces | path.skipped << WAITING_OBJECT_SHIFT;
  if (has(FEATURE_LIGHT_AOVS) && path.part == PART_TRANSMISSION) progress |= WAITING_IS_TRANSMITTED;
  pixels[record + 3u] = uvec4(path.media, progress, floatBitsToUint(path.skip));
}

// Stores the children that wait for the first one. The child that is stored last is followed first. `waiting` is the
// number of rays that already wait. Returns the new number.
uint store_children(uint number, uint waiting, Children children, ShadingPoint point, bool touches) {
  if (children.is_mirrored && children.is_refracted) {
    store_waiting(number, waiting, children.through);
    ++waiting;
  }
  if (!has(FEATURE_DISPERSION)) return waiting;
  // Without a mirror ray, the ray of the first colour is the path itself.
  uint colors = children.is_mirrored ? children.colors : children.colors & (children.colors - 1u);
  for (uint left = colors; left != 0u;) {
    uint color = uint(findMSB(left));
    left &= ~(1u << color);
    Path child = children.through;
    send_color(child, point, touches, color);
    store_waiting(number, waiting, child);
    ++waiting;
  }
  return waiting;
}
