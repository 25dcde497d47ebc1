// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Three slabs between parallel planes, in the box's own frame. A ray is inside a box in one interval, which one plane
// begins and one ends; an edge belongs to both its faces, so edges and corners do not leak.

vec3 box_center(Primitive p) { return p.a.xyz; }
vec3 box_half_size(Primitive p) { return vec3(p.a.w, p.b.xy); }
vec3 box_turn(Primitive p) { return vec3(p.b.zw, uintBitsToFloat(p.c.x)); }

// Returns v rotated by the unit quaternion (turn, w): v + 2 turn x (turn x v + w v). Because |turn| < 0.53, the square
// root is accurate to u and the error of a component is at most 5 u |v|. Without a rotation the error is 0.
vec3 turned(vec3 v, vec3 turn, float w) {
  precise vec3 inner = cross3(turn, v) + w * v;
  precise vec3 result = v + 2.0 * cross3(turn, inner);
  return result;
}

float scalar_of(vec3 turn) {
  precise float w = sqrt(1.0 - dot3(turn, turn));
  return w;
}

float component(vec3 v, uint axis) { return axis == 0u ? v.x : (axis == 1u ? v.y : v.z); }

// Returns the number of a face: twice its axis, plus 1 on the positive side.
uint face_of(uint axis, bool is_positive) { return 2u * axis + (is_positive ? 1u : 0u); }

// Returns the ends of a box with the method of Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986. It starts
// from the closest approach to the centre, where rounding is small compared with the box. The rotation is the same for
// the origin and all three slabs, so its rounding only rotates and moves the box as a whole.
Inside ends_of_box(Ray ray, Primitive p) {
  vec3 given_size = box_half_size(p);
  float largest = max_abs(given_size);
  Approach near = approach(ray, box_center(p));
  float scale = power_of_two_inverse(largest);
  vec3 turn = box_turn(p);
  float w = scalar_of(turn);
  precise vec3 half_size = given_size * scale;
  precise vec3 scaled = near.offset * scale;
  vec3 offset = turned(scaled, turn, -w);
  vec3 direction = turned(ray.direction, turn, -w);

  // A ray parallel to a slab hits its planes at +-infinity, or nowhere.
  vec3 signs = signs_of(direction);
  precise vec3 inverse = 1.0 / (signs * max(abs(direction), vec3(TWO_POW_MINUS_80)));
  precise vec3 entries = (-signs * half_size - offset) * inverse;
  precise vec3 exits = (signs * half_size - offset) * inverse;
  uint entry_axis = entries.x >= entries.y ? (entries.x >= entries.z ? 0u : 2u) : (entries.y >= entries.z ? 1u : 2u);
  uint exit_axis = exits.x <= exits.y ? (exits.x <= exits.z ? 0u : 2u) : (exits.y <= exits.z ? 1u : 2u);
  float entry = component(entries, entry_axis);
  float exit = component(exits, exit_axis);
  if (!is_interval(entry, exit)) return NOWHERE;
  float unscale = 1.0 / scale;
  precise float t_entry = near.t_far + (near.t_near + entry * unscale);
  precise float t_exit = near.t_far + (near.t_near + exit * unscale);
  return Inside(t_entry, face_of(entry_axis, component(signs, entry_axis) < 0.0), t_exit,
                face_of(exit_axis, component(signs, exit_axis) > 0.0));
}

Crossing intersect_box(Ray ray, Primitive p) { return nearest_crossing(ray, ends_of_box(ray, p)); }

SurfacePoint box_surface(Ray ray, Primitive p, Hit hit) {
  vec3 half_size = box_half_size(p);
  vec3 turn = box_turn(p);
  float w = scalar_of(turn);
  precise vec3 from_center = (ray.origin - box_center(p)) + hit.t * ray.direction;
  vec3 local = clamp(turned(from_center, turn, -w), -half_size, half_size);
  uint axis = hit.part / 2u;
  float side = (hit.part & 1u) != 0u ? 1.0 : -1.0;
  vec3 along = vec3(axis == 0u ? 1.0 : 0.0, axis == 1u ? 1.0 : 0.0, axis == 2u ? 1.0 : 0.0);
  precise vec3 face = side * half_size;
  precise vec3 outward = side * along;
  local = mix(local, face, greaterThan(along, vec3(0.0)));
  precise vec3 position = box_center(p) + turned(local, turn, w);
  vec3 normal = normalize3(turned(outward, turn, w));
  float size = half_size.x + half_size.y + half_size.z;
  precise float lift = UNIT_ROUNDOFF * (8.0 * max_abs(position) + 16.0 * size);
  return SurfacePoint(position, normal, lift);
}
