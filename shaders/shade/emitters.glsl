// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Surfaces that emit light as sources, and the choice of one of many sources (docs/model.md, "Surfaces that emit
// light"). A source of kind LIGHT_EMITTERS has a table of elements: triangles, faces of shapes, or lights. A sample
// chooses one of them with a known chance. Surfaces need FEATURE_EMITTERS, lights FEATURE_CHOSEN_LIGHTS.

// Returns a word of the tables, which follow the records of the sources.
uvec4 load_emitter_words(uint texel) {
  uint index = LIGHT_TEXELS * VIEW.first_index.y + texel;
  return FETCHES_TEXELS == 0u ? surfaces[index].corners_material : texelFetch(shading_texels, int(index));
}

// An element of a table.
struct Emitter {
  uint index;    // the primitive; for a light, its record, counted from the first source
  uint part;     // Hit::part of points on the primitive, or EMITTER_IS_LIGHT
  uint corner;   // of a triangle: that of its rectangle, with FEATURE_RECT_EMITTERS
  float area;    // of the part in the world
  float chance;  // the probability that a sample chooses it
};

// Chooses an element for a point of the unit square, given by its bits, and sets `u` to the point that remains. The
// first coordinate selects the element. Cells of this coordinate, one for each element, bound the search (Chen and
// Asau, "On Generating Random Variates from an Empirical Distribution", 1974).
Emitter choose_emitter(LightRecord light, uvec2 bits, out vec2 u) {
  uint count = light.kind.y;
  uint cell;
  uint unused;
  umulExtended(bits.x, count, cell, unused);
  uint low = load_emitter_words(light.kind.w + EMITTER_TEXELS * cell).z;
  uint high = cell + 1u < count ? load_emitter_words(light.kind.w + EMITTER_TEXELS * (cell + 1u)).z : count - 1u;
  do {
    if (low < high) {
      uint middle = (low + high + 1u) / 2u;
      bool is_later = load_emitter_words(light.kind.w + EMITTER_TEXELS * middle).x <= bits.x;
      low = is_later ? middle : low;
      high = is_later ? high : middle - 1u;
    }
  } while (low < high);
  uvec4 range = load_emitter_words(light.kind.w + EMITTER_TEXELS * low);
  uvec4 element = load_emitter_words(light.kind.w + EMITTER_TEXELS * low + 1u);
  float chance = uintBitsToFloat(range.y);
  precise float place = (float(bits.x - range.x) + 0.5) * 2.3283064365386963e-10 / chance;
  u = vec2(min(place, LARGEST_BELOW_ONE), unit_square_point(bits).y);
  return Emitter(element.x, element.y, element.z, uintBitsToFloat(element.w), chance);
}

// The smallest and the largest solid angle of a triangle for which directions are chosen by solid angle. For a smaller
// triangle, points are chosen by area. A larger one nearly covers a half space; directions of the half space are then
// chosen, and some of them miss the triangle. In fp32, the method between these limits has too large an error beyond
// them.
const float LEAST_TRIANGLE_ANGLE = 0.00390625;
const float LARGEST_TRIANGLE_ANGLE = 6.0;

// A triangle as seen from a point. All lengths are scaled by a power of two, so that no product overflows or vanishes.
struct SeenTriangle {
  vec3 a;  // the first corner, relative to the point
  vec3 edge1;
  vec3 edge2;
  vec3 normal;   // product of the edges: twice the area times the unit normal
  float height;  // dot product of `normal` and the way from the corner to the point; positive in front
  float solid_angle;
  float unit;
};

// `corners` is a triangle of the world, and `position` the point in its coordinates.
SeenTriangle see_triangle(Primitive corners, vec3 position) {
  precise vec3 a = corner0(corners) - position;
  precise vec3 edge1 = corner1(corners) - corner0(corners);
  precise vec3 edge2 = corner2(corners) - corner0(corners);
  SeenTriangle seen;
  seen.unit = power_of_two_inverse(max(max_abs(a), max(max_abs(edge1), max(max_abs(edge2), SMALLEST_NORMAL))));
  precise vec3 to_a = a * seen.unit;
  precise vec3 e1 = edge1 * seen.unit;
  precise vec3 e2 = edge2 * seen.unit;
  seen.a = to_a;
  seen.edge1 = e1;
  seen.edge2 = e2;
  seen.normal = cross3(e1, e2);
  precise float height = -dot3(seen.normal, to_a);
  seen.height = height;
  // Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983.
  precise vec3 to_b = to_a + e1;
  precise vec3 to_c = to_a + e2;
  float la = length3(to_a);
  float lb = length3(to_b);
  float lc = length3(to_c);
  precise float base = la * lb * lc + dot3(to_a, to_b) * lc + dot3(to_b, to_c) * la + dot3(to_c, to_a) * lb;
  precise float ratio = abs(height) / max(abs(base), SMALLEST_NORMAL);
  float angle = arc_tangent(ratio);
  precise float solid_angle = 2.0 * (base < 0.0 ? 3.14159265 - angle : angle);
  seen.solid_angle = solid_angle;
  return seen;
}

// Returns 1 / the density per solid angle with which the triangle's point at `to_point`, relative to the position of
// see_triangle() and scaled, is chosen.
float inverse_density_on(SeenTriangle seen, vec3 to_point) {
  if (seen.solid_angle >= LEAST_TRIANGLE_ANGLE) {
    return seen.solid_angle <= LARGEST_TRIANGLE_ANGLE ? seen.solid_angle : 6.28318531;
  }
  precise float d2 = dot3(to_point, to_point);
  precise float inverse = 0.5 * abs(seen.height) / max(d2 * sqrt(d2), SMALLEST_NORMAL);
  return inverse;
}

// Returns the component of v at right angles to the unit vector `axis`, of length 1.
vec3 unit_across(vec3 v, vec3 axis) {
  precise vec3 across = v - dot3(v, axis) * axis;
  return normalize3(across);
}

// Returns the direction at the angle to the unit vector `axis` whose cosine is 1 - below, towards `across`.
vec3 direction_on_arc(vec3 axis, vec3 across, float below) {
  precise vec3 direction = (1.0 - below) * axis + sqrt(max(below * (2.0 - below), 0.0)) * across;
  return direction;
}

// Returns a direction with uniform density over the solid angle of a triangle (Arvo, "Stratified Sampling of Spherical
// Triangles", 1995). Differences of cosines are computed without cancellation.
vec3 direction_to_triangle(SeenTriangle seen, vec2 u) {
  vec3 a = normalize3(seen.a);
  precise vec3 to_b = seen.a + seen.edge1;
  precise vec3 to_c = seen.a + seen.edge2;
  vec3 b = normalize3(to_b);
  // The sides at a as directions, and the angle between them.
  vec3 along_b = unit_across(to_b, a);
  vec3 along_c = unit_across(to_c, a);
  float cosine_a = dot3(along_b, along_c);
  float sine_a = length3(cross3(along_b, along_c));
  precise vec3 side = b - a;
  precise float below_side = 0.5 * dot3(side, side);
  // The part u.x of the solid angle lies up to a point q of the side from a to c.
  precise float half_part = 0.5 * u.x * seen.solid_angle;
  vec2 half_turn = cosine_and_sine(half_part);
  precise float sine = 2.0 * half_turn.x * half_turn.y;
  precise float below = 2.0 * half_turn.y * half_turn.y;
  precise float s = sine * cosine_a - (1.0 - below) * sine_a;
  precise float t = (1.0 - below) * cosine_a + sine * sine_a;
  precise float p = sine * sine_a - below * cosine_a;
  precise float v = sine * cosine_a - sine_a * (below_side - below);
  precise float divisor = (v * s + p * t) * sine_a;
  precise float below_q = (v * below + p * sine) / (abs(divisor) > SMALLEST_NORMAL ? divisor : SMALLEST_NORMAL);
  vec3 q = direction_on_arc(a, along_c, clamp(below_q, 0.0, 2.0));
  // Then a point of the arc from b to q, with uniform density of its cosine.
  precise vec3 apart = q - b;
  precise float below_point = 0.5 * u.y * dot3(apart, apart);
  return direction_on_arc(b, unit_across(q, b), below_point);
}

// Returns the weights of the second and third corner at the point of a triangle in this direction.
vec2 weights_in_direction(SeenTriangle seen, vec3 direction) {
  precise float along = dot3(seen.normal, direction);
  precise float t = -seen.height / (abs(along) > SMALLEST_NORMAL ? along : SMALLEST_NORMAL);
  precise vec3 from_a = t * direction - seen.a;
  precise float square = max(dot3(seen.normal, seen.normal), SMALLEST_NORMAL);
  precise vec2 weights =
      vec2(dot3(cross3(from_a, seen.edge2), seen.normal), dot3(cross3(seen.edge1, from_a), seen.normal)) / square;
  return weights;
}

// A point of an emissive surface as seen from another point.
struct LampPoint {
  vec2 weights;           // of a triangle's second and third corner
  float inverse_density;  // 1 / density per solid angle; 0 if there is no such point
};

LampPoint point_of_triangle(SeenTriangle seen, vec2 u) {
  LampPoint lamp;
  // A low-distortion map between square and triangle (Heitz, 2019).
  precise vec2 halves = u.y > u.x ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
  lamp.weights = halves;
  bool is_seen = true;
  if (seen.solid_angle >= LEAST_TRIANGLE_ANGLE) {
    vec3 direction = direction_to_triangle(seen, u);
    if (seen.solid_angle > LARGEST_TRIANGLE_ANGLE) {
      sample_u = u;
      direction = sample_cone(normalize3(seen.height > 0.0 ? -seen.normal : seen.normal), 1.0).direction;
    }
    vec2 weights = weights_in_direction(seen, direction);
    precise float both = weights.x + weights.y;
    is_seen = seen.solid_angle <= LARGEST_TRIANGLE_ANGLE || (weights.x >= 0.0 && weights.y >= 0.0 && both <= 1.0);
    weights = clamp(weights, vec2(0.0), vec2(1.0));
    precise float sum = max(weights.x + weights.y, 1.0);
    precise vec2 inside = weights / sum;
    lamp.weights = inside;
  }
  precise vec3 to_point = seen.a + (lamp.weights.x * seen.edge1 + lamp.weights.y * seen.edge2);
  lamp.inverse_density = is_seen ? inverse_density_on(seen, to_point) : 0.0;
  return lamp;
}

// Chooses a direction to a sphere with uniform density over its solid angle: the cone around it, or all directions
// inside it. Returns the direction and 1 / density.
struct LampDirection {
  vec3 direction;
  float inverse_density;
};

// Returns 1 for a point inside a sphere, -1 outside it, and 0 for a point of the outer side of the sphere itself, up to
// rounding. A point of the sphere is on the side to which its geometric normal points.
float side_of_sphere(vec3 to_center, float radius, vec3 position, vec3 facing) {
  float distance = length3(to_center);
  precise float doubt = UNIT_ROUNDOFF * (16.0 * max_abs(position) + 32.0 * (radius + max_abs(to_center)));
  precise float height = distance - radius;
  if (abs(height) <= doubt) return dot3(facing, to_center) > 0.0 ? 1.0 : 0.0;
  return distance < radius ? 1.0 : -1.0;
}

// Returns 1 minus the cosine of half the angle of the cone of directions to a sphere; 2 inside it.
float cap_of_sphere(vec3 to_center, float radius, bool is_inside) {
  float unit = power_of_two_inverse(max(max_abs(to_center), radius));
  precise vec3 to = to_center * unit;
  precise float r = radius * unit;
  precise float d2 = dot3(to, to);
  precise float r2 = r * r;
  precise float ratio = r2 / max(d2, SMALLEST_NORMAL);
  precise float cap = ratio / (1.0 + sqrt(1.0 - min(ratio, 1.0)));
  return is_inside ? 2.0 : cap;
}

// Returns the point of a sphere in a direction of its cone, relative to the center.
vec3 sphere_point(vec3 to_center, float radius, bool is_inside, ConeSample cone) {
  float unit = power_of_two_inverse(max(max_abs(to_center), radius));
  precise vec3 to = to_center * unit;
  precise float r = radius * unit;
  precise float d2 = dot3(to, to);
  precise float r2 = r * r;
  precise float half_chord = sqrt(max(r2 - d2 * cone.below * (2.0 - cone.below), 0.0));
  precise float along = sqrt(d2) * (1.0 - cone.below);
  precise float distance = (is_inside ? along + half_chord : along - half_chord) / unit;
  precise vec3 from_center = distance * cone.direction - to_center;
  return normalize3(from_center);
}

// True if other shapes than spheres may emit light.
const uint OTHER_SOLIDS = FEATURE_BIT(FEATURE_CYLINDERS) | FEATURE_BIT(FEATURE_CONES) | FEATURE_BIT(FEATURE_BOXES) |
                          FEATURE_BIT(FEATURE_CAPSULES);

// A point of a shape, relative to its center, and its unit normal.
struct ShapePoint {
  vec3 offset;
  vec3 normal;
};

// Returns the direction across an axis for a number from 0 to 1.
vec3 direction_around(vec3 axis, float u) {
  vec3 across;
  vec3 along;
  make_frame(axis, across, along);
  precise float angle = 6.28318531 * u - 3.14159265;
  vec2 turn = cosine_and_sine(angle);
  precise vec3 direction = turn.x * across + turn.y * along;
  return direction;
}

// The following functions return the point of a part of a shape for a point of the unit square, with uniform density
// over the area.
ShapePoint point_of_frustum(Frustum f, uint part, vec2 u) {
  precise float change = f.slope * f.half_height;
  precise float bottom = max(f.radius - change, 0.0);
  precise float top = max(f.radius + change, 0.0);
  vec3 around = direction_around(f.axis, u.y);
  // The area of the side between two radii is in proportion to the difference of their squares.
  float end = part == PART_TOP ? top : bottom;
  precise float of_side = sqrt(bottom * bottom + u.x * (top * top - bottom * bottom));
  precise float of_end = end * sqrt(u.x);
  precise float share = u.x * (bottom + top) / max(of_side + bottom, SMALLEST_NORMAL);
  precise float height =
      part == PART_SIDE ? (2.0 * share - 1.0) * f.half_height : (part == PART_TOP ? f.half_height : -f.half_height);
  precise vec3 offset = height * f.axis + (part == PART_SIDE ? of_side : of_end) * around;
  precise vec3 outward = around - f.slope * f.axis;
  vec3 of_cap = part == PART_TOP ? f.axis : -f.axis;
  return ShapePoint(offset, part == PART_SIDE ? normalize3(outward) : of_cap);
}

ShapePoint point_of_box(Primitive p, uint part, vec2 u) {
  vec3 half_size = box_half_size(p);
  uint axis = part / 2u;
  precise vec2 in_face = 2.0 * u - 1.0;
  float side = (part & 1u) != 0u ? 1.0 : -1.0;
  vec3 place = axis == 0u ? vec3(side, in_face) : (axis == 1u ? vec3(in_face.y, side, in_face.x) : vec3(in_face, side));
  precise vec3 along = side * vec3(axis == 0u ? 1.0 : 0.0, axis == 1u ? 1.0 : 0.0, axis == 2u ? 1.0 : 0.0);
  precise vec3 local = place * half_size;
  vec3 turn = box_turn(p);
  float w = scalar_of(turn);
  return ShapePoint(turned(local, turn, w), normalize3(turned(along, turn, w)));
}

ShapePoint point_of_capsule(Primitive p, uint part, vec2 u) {
  Capsule c = capsule_of(p);
  if (part == PART_SIDE) {
    ShapePoint on_side = point_of_frustum(side_of(c, vec3(0.0)), part, u);
    precise vec3 offset = c.side_middle * c.axis + on_side.offset;
    return ShapePoint(offset, on_side.normal);
  }
  // Zones of spheres with equal heights have equal areas.
  precise float difference = c.radius_bottom - c.radius_top;
  precise float sine = c.has_side ? difference / (2.0 * c.half_height) : (part == PART_TOP ? -1.0 : 1.0);
  bool is_top = part == PART_TOP;
  precise float z = is_top ? sine + u.x * (1.0 - sine) : -1.0 + u.x * (1.0 + sine);
  precise vec3 normal = sqrt(max((1.0 - z) * (1.0 + z), 0.0)) * direction_around(c.axis, u.y) + z * c.axis;
  float radius = is_top ? c.radius_top : c.radius_bottom;
  precise vec3 offset = (is_top ? c.half_height : -c.half_height) * c.axis + radius * normal;
  return ShapePoint(offset, normal);
}

ShapePoint point_of_shape(Primitive p, uint part, vec2 u) {
  if (has(FEATURE_CYLINDERS) && kind_of(p) == KIND_CYLINDER) return point_of_frustum(cylinder_of(p), part, u);
  if (has(FEATURE_CONES) && kind_of(p) == KIND_CONE) return point_of_frustum(cone_of(p), part, u);
  if (has(FEATURE_BOXES) && kind_of(p) == KIND_BOX) return point_of_box(p, part, u);
  if (has(FEATURE_CAPSULES)) return point_of_capsule(p, part, u);
  return ShapePoint(vec3(0.0), vec3(0.0, 0.0, 1.0));
}

// Returns a length that is at least the distance of any point of a shape from its center.
float largest_of_shape(Primitive p) {
  precise float sum = abs(p.a.w) + abs(p.b.w);
  if (has(FEATURE_BOXES) && kind_of(p) == KIND_BOX) {
    vec3 half_size = box_half_size(p);
    sum = half_size.x + half_size.y + half_size.z;
  } else if (has(FEATURE_CONES) && kind_of(p) == KIND_CONE) {
    Frustum f = cone_of(p);
    sum = f.half_height + f.radius + abs(f.slope) * f.half_height;
  } else if (has(FEATURE_CAPSULES) && kind_of(p) == KIND_CAPSULE) {
    sum += uintBitsToFloat(p.c.x);
  }
  return sum;
}

// Returns 1 / the density per solid angle of a point that is chosen by area.
float inverse_density_by_area(float area, vec3 normal, vec3 to_point) {
  float size = max(max_abs(to_point), SMALLEST_NORMAL);
  float unit = power_of_two_inverse(size);
  precise vec3 to = to_point * unit;
  precise float d2 = dot3(to, to);
  precise float inverse = (area * unit * unit) * abs(dot3(normal, to)) / (d2 * sqrt(d2));
  return inverse;
}

// Returns the radiance that a point of a surface emits at an angle with this cosine to its normal. Textures have their
// finest level.
vec3 emission_of(Primitive p, SurfaceRecord surface, Hit hit, float cosine) {
  MaterialRecord material = material_of(surface);
  precise vec3 emission = material.emissive.xyz * texel_at_hit(slot_number(material.cover.w), hit, p, surface).xyz;
  float share = 1.0;
  if (has(FEATURE_BLENDING) && (flags_of(material) & MATERIAL_BLENDS) != 0u) share = clamp(material.cover.x, 0.0, 1.0);
  if (has(FEATURE_HOLES) && has_holes(material, surface)) {
    precise vec3 weights = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
    float alpha = alpha_at(material, p, surface, weights, 1.0, 0.0);
    bool blends = has(FEATURE_BLENDING) && (flags_of(material) & MATERIAL_BLENDS) != 0u;
    share = blends ? clamp(alpha, 0.0, 1.0) : (alpha < material.cover.y ? 0.0 : 1.0);
  }
  if (has(FEATURE_COATS) && is_extended(material)) {
    // A coat reflects a part of the light from below (seen_coat).
    ExtensionRecord record = extension_of(material);
    precise float weight = record.coat.x * texel_at_hit(record.coat_slots.x, hit, p, surface).x;
    precise float c = 1.0 - clamp(cosine, 0.0, 1.0);
    precise float c2 = c * c;
    precise float left = share * (1.0 - weight * (0.04 + 0.96 * (c2 * c2 * c)));
    share = left;
  }
  precise vec3 emitted = share * emission;
  return emitted;
}

// The bound on the error of the distance between a hit and the surface, which grows with the ray's length (hard cases
// 1 to 38): a multiple of the lengths from which it is computed. In an instance it is larger (change_level.glsl).
const float HIT_DOUBT = 32.0 * UNIT_ROUNDOFF;
const float INSTANCE_DOUBT = 128.0 * UNIT_ROUNDOFF;

// Returns the length along the normal of an emissive surface at which shadow rays to its points end, so that the
// surface itself does not block them.
float height_of_end(SurfacePoint lamp, vec3 to_point, float size, uint part) {
  precise float height = lamp.lift + HIT_DOUBT * (max_abs(to_point) + size);
  if (is_instance_part(part)) {
    uint record = part - FIRST_INSTANCE_PART;
    float radius = uintBitsToFloat(load_node_words(record, 3u).w);
    precise float higher = height + INSTANCE_DOUBT * (max_abs(to_point) + radius);
    height = higher;
  }
  return height;
}

// Returns the corners of a triangle relative to `origin`, and its size.
Primitive triangle_of_emitter(Primitive p, uint part, out vec3 origin, out float size) {
  origin = vec3(0.0);
  if (is_instance_part(part)) {
    InstanceMap map = load_instance_map(part - FIRST_INSTANCE_PART);
    origin = map.origin;
    p = place_about_origin(p, load_instance_look(part));
  }
  precise vec3 edge1 = corner1(p) - corner0(p);
  precise vec3 edge2 = corner2(p) - corner0(p);
  size = max(max_abs(edge1), max_abs(edge2));
  return p;
}

// Returns a corner of a triangle; `corner` may be up to 4.
vec3 corner_of(Primitive p, uint corner) {
  uint number = corner < 3u ? corner : corner - 3u;
  return number == 0u ? corner0(p) : (number == 1u ? corner1(p) : corner2(p));
}

// Returns the rectangle two of whose sides are those of the triangle p at a corner. It is a rectangular light that
// shines to the triangle's front.
LightRecord rectangle_of(Primitive p, uint corner) {
  vec3 a = corner_of(p, corner);
  precise vec3 side1 = corner_of(p, corner + 1u) - a;
  precise vec3 side2 = corner_of(p, corner + 2u) - a;
  precise vec3 middle = a + 0.5 * (side1 + side2);
  float unit = power_of_two_inverse(max(max(max_abs(side1), max_abs(side2)), SMALLEST_NORMAL));
  precise vec3 scaled1 = side1 * unit;
  precise vec3 scaled2 = side2 * unit;
  precise float half_width = 0.5 * length3(scaled1) / unit;
  precise float half_height = 0.5 * length3(scaled2) / unit;
  vec3 right = normalize3(side1);
  LightRecord rect;
  rect.position = vec4(middle, half_height);
  rect.direction = vec4(triangle_normal(p), half_width);
  rect.diffuse = vec4(vec3(0.0), right.x);
  rect.specular = vec4(vec3(0.0), right.y);
  rect.kind = uvec4(LIGHT_RECT, 0u, floatBitsToUint(right.z), 0u);
  return rect;
}

// Sets the point of a rectangle and the size of the rectangle. Returns 1 / the density per solid angle of the point, as
// for a rectangular light that shines to the side of `position`.
float sample_rectangle(LightRecord rect, vec3 position, vec2 u, out SurfacePoint lamp, out float size) {
  vec3 normal = rect.direction.xyz;
  precise vec3 from_middle = position - rect.position.xyz;
  float height = dot3(normal, from_middle);
  precise float reach = 2.0 * (rect.direction.w + rect.position.w);
  size = reach;
  LightRecord seen = rect;
  seen.direction.xyz = height < 0.0 ? -normal : normal;
  sample_u = u;
  LightSample sampled = sample_rect(seen, position);
  precise vec3 place = position + sampled.direction;
  precise float lift = 8.0 * UNIT_ROUNDOFF * (max_abs(place) + reach);
  lamp = SurfacePoint(place, normal, lift);
  // A point in the plane of a rectangle receives no light from it.
  precise float doubt = lift + 8.0 * UNIT_ROUNDOFF * (max_abs(position) + reach);
  return abs(height) > doubt ? sampled.strength : 0.0;
}

// Returns a point of a lamp as a source of light. The shadow ray ends at this height above it.
LightSample light_of_lamp(SurfacePoint lamp, vec3 to_point, float height, float strength, bool is_dark) {
  float front = -dot3(lamp.normal, to_point);
  precise vec3 to_end = to_point + (front < 0.0 ? -height : height) * lamp.normal;
  // A point in the tangent plane of the lamp's point, up to rounding, receives no light: it may be the same point.
  bool is_lit = abs(front) > height && !is_dark;
  return LightSample(to_end, 1.0, is_lit ? strength : 0.0);
}

// Returns a point of a source that is an emissive rectangle. Its record is that of a rectangular light which shines to
// the front, except that kind.y is 1 if the back is dark.
LightSample sample_rectangle_source(LightRecord light, uvec2 bits, vec3 position) {
  precise float x = (float(bits.x) + 0.5) * 2.3283064365386963e-10;
  vec2 u = vec2(min(x, LARGEST_BELOW_ONE), unit_square_point(bits).y);
  SurfacePoint lamp;
  float size;
  float inverse_density = sample_rectangle(light, position, u, lamp, size);
  precise vec3 to_point = lamp.position - position;
  bool is_of_back = dot3(lamp.normal, to_point) > 0.0;
  float height = height_of_end(lamp, to_point, size, PART_SIDE);
  return light_of_lamp(lamp, to_point, height, inverse_density, is_of_back && light.kind.y != 0u);
}

// Returns a point of an emissive surface as a source of light at `position`, where the geometric normal is `facing`.
// Sets the powers of the source to the radiance of the surface. The shadow ray ends just before the surface.
LightSample sample_emitter(Emitter emitter, vec2 u, vec3 position, vec3 facing, inout LightRecord light) {
  Primitive p = load_primitive_of(emitter.index, emitter.part);
  SurfaceRecord surface = load_surface_of(emitter.index, emitter.part);
  Hit hit = Hit(0.0, 0.0, 0.0, emitter.part, emitter.index, 0u);
  float inverse_density = 0.0;
  float size = 0.0;
  SurfacePoint lamp = SurfacePoint(vec3(0.0), vec3(0.0, 0.0, 1.0), 0.0);
  if (has(FEATURE_SPHERES) && kind_of(p) == KIND_SPHERE) {
    size = sphere_radius(p);
    precise vec3 to_center = sphere_center(p) - position;
    float side = side_of_sphere(to_center, size, position, facing);
    bool is_inside = side > 0.0;
    float cap = cap_of_sphere(to_center, size, is_inside);
    vec3 axis = max_abs(to_center) > 0.0 ? normalize3(to_center) : vec3(0.0, 0.0, 1.0);
    sample_u = u;
    ConeSample cone = sample_cone(axis, cap);
    lamp.normal = sphere_point(to_center, size, is_inside, cone);
    precise vec3 on_sphere = sphere_center(p) + size * lamp.normal;
    lamp.position = on_sphere;
    precise float lift = UNIT_ROUNDOFF * (8.0 * max_abs(on_sphere) + 16.0 * size);
    lamp.lift = lift;
    precise float solid_angle = 6.28318531 * cap;
    // A sphere does not light its own outside.
    inverse_density = side != 0.0 ? solid_angle : 0.0;
  } else if (OTHER_SOLIDS != 0u && kind_of(p) != KIND_TRIANGLE) {
    ShapePoint point = point_of_shape(p, emitter.part, u);
    precise vec3 on_shape = p.a.xyz + point.offset;
    lamp.position = on_shape;
    lamp.normal = point.normal;
    size = largest_of_shape(p);
    precise float lift = UNIT_ROUNDOFF * (8.0 * max_abs(on_shape) + 16.0 * size);
    lamp.lift = lift;
    precise vec3 way = on_shape - position;
    inverse_density = inverse_density_by_area(emitter.area, point.normal, way);
  } else if (has(FEATURE_RECT_EMITTERS)) {
    inverse_density = sample_rectangle(rectangle_of(p, emitter.corner), position, u, lamp, size);
  } else if (has(FEATURE_TRIANGLES)) {
    vec3 origin;
    Primitive corners = triangle_of_emitter(p, emitter.part, origin, size);
    precise vec3 from_origin = position - origin;
    SeenTriangle seen = see_triangle(corners, from_origin);
    LampPoint point = point_of_triangle(seen, u);
    hit.u = point.weights.x;
    hit.v = point.weights.y;
    // The surface of a triangle does not depend on the ray. A ray of the packet would be a cycle, with which glslang 12
    // never ends (change_level.glsl).
    Ray unused;
    if (is_instance_part(hit.part)) {
      lamp = instance_surface(p, hit);
    } else {
      lamp = triangle_surface(unused, p, hit);
    }
    // A point in the plane of a triangle receives no light from it.
    precise float doubt = (lamp.lift + 8.0 * UNIT_ROUNDOFF * (max_abs(position) + size)) * seen.unit;
    bool is_apart = abs(seen.height) > doubt * length3(seen.normal);
    inverse_density = is_apart ? point.inverse_density : 0.0;
  }
  precise vec3 to_point = lamp.position - position;
  float front = -dot3(lamp.normal, to_point);
  bool is_of_back = front < 0.0;
  bool is_solid = !has(FEATURE_TRIANGLES) || kind_of(p) != KIND_TRIANGLE;
  bool is_dark = is_of_back && !is_solid && (flags_of(material_of(surface)) & MATERIAL_IS_ONE_SIDED) != 0u;
  float height = height_of_end(lamp, to_point, size, emitter.part);
  precise float cosine = abs(front) / max(length3(to_point), SMALLEST_NORMAL);
  vec3 radiance = emission_of(p, surface, hit, cosine);
  light.diffuse.xyz = radiance;
  light.specular.xyz = radiance;
  precise float strength = light.position.w * inverse_density / emitter.chance;
  return light_of_lamp(lamp, to_point, height, strength, is_dark);
}
