// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The convex hull of two spheres: both spheres, and the frustum of the cone that touches them, between its circles of
// contact. The hull and each of the three parts are convex, so a ray is inside from the first entry to the last exit,
// and no seam can leak.
#include "trace/primitives/frustum.glsl"

struct Capsule {
  vec3 center;  // the point halfway between the centres of the spheres
  vec3 axis;
  float half_height;  // distance from `center` to either sphere's centre
  float radius_bottom;
  float radius_top;
  bool has_side;      // false if one sphere contains the other
  float side_middle;  // middle of the frustum, along the axis from the centre
};

Capsule capsule_of(Primitive p) {
  float half_height = p.b.w;
  float bottom = p.a.w;
  float top = uintBitsToFloat(p.c.x);
  precise float difference = bottom - top;
  precise float height = 2.0 * half_height;
  bool has_side = height > abs(difference);
  precise float middle = has_side ? 0.5 * (bottom + top) * (difference / height) : 0.0;
  return Capsule(p.a.xyz, p.b.xyz, half_height, bottom, top, has_side, middle);
}

// Returns the side of the capsule, a frustum. The sine of the angle between its generators and the axis is s = (bottom
// - top) / height. The frustum touches the spheres at s times their radii along the axis; its radii there are the
// spheres' radii times the cosine. The square of the cosine is computed from its factors, because the remaining height
// is small if one sphere almost contains the other.
Frustum side_of(Capsule c, vec3 center) {
  precise float difference = c.radius_bottom - c.radius_top;
  precise float height = 2.0 * c.half_height;
  precise float sine = difference / height;
  precise float cosine2 = ((height - difference) / height) * ((height + difference) / height);
  precise float cosine = sqrt(cosine2);
  precise float half_height = c.half_height * cosine2;
  precise float radius = 0.5 * (c.radius_bottom + c.radius_top) * cosine;
  precise float slope = -sine / cosine;
  return Frustum(center, c.axis, half_height, radius, slope, false);
}

Inside hull_of(Inside a, Inside b) {
  if (!(b.entry <= b.exit)) return a;
  if (!(a.entry <= a.exit)) return b;
  bool takes_entry = b.entry < a.entry;
  bool takes_exit = b.exit > a.exit;
  return Inside(takes_entry ? b.entry : a.entry, takes_entry ? b.entry_part : a.entry_part,
                takes_exit ? b.exit : a.exit, takes_exit ? b.exit_part : a.exit_part);
}

// Returns the approach to a point. `from_point` is the vector from this point to the ray's origin.
Approach approach_from(Ray ray, vec3 from_point) {
  ray.origin = from_point;
  return approach(ray, vec3(0.0));
}

Inside inside_end(Ray ray, vec3 from_center, float radius, uint part) {
  if (!(radius > 0.0)) return NOWHERE;
  Approach near = approach_from(ray, from_center);
  float scale = power_of_two_inverse(radius);
  float chord2 = chord_square(ray, near, radius, scale);
  if (!is_interval(0.0, chord2)) return NOWHERE;
  precise float half_chord = sqrt(chord2) * (1.0 / scale);
  precise float entry = near.t_far + (near.t_near - half_chord);
  precise float exit = near.t_far + (near.t_near + half_chord);
  return Inside(entry, part, exit, part);
}

// The centres of the parts are never rounded in the world, but only relative to the ray's origin. A capsule far from
// the world's origin is therefore as exact as one near it.
Inside ends_of_capsule(Ray ray, Primitive p) {
  Capsule c = capsule_of(p);
  precise vec3 from_center = ray.origin - c.center;
  precise vec3 up = c.half_height * c.axis;
  precise vec3 from_bottom = from_center + up;
  precise vec3 from_top = from_center - up;
  Inside inside = inside_end(ray, from_bottom, c.radius_bottom, PART_BOTTOM);
  inside = hull_of(inside, inside_end(ray, from_top, c.radius_top, PART_TOP));
  if (c.has_side) {
    precise vec3 from_middle = from_center - c.side_middle * c.axis;
    inside = hull_of(inside, inside_frustum(ray, approach_from(ray, from_middle), side_of(c, vec3(0.0))));
  }
  return inside;
}

Crossing intersect_capsule(Ray ray, Primitive p) { return nearest_crossing(ray, ends_of_capsule(ray, p)); }

// Returns the part to which a point of the surface belongs. This part may differ from the part that the ray hit. Where
// two parts touch, rounding selects either of them in a strip whose width is the square root of the rounding error, and
// there the normals differ more than the surfaces. The sphere of the hull that touches the surface there has its centre
// at `foot` on the axis.
uint capsule_part(Capsule c, Frustum side, vec3 from_center) {
  if (!c.has_side) return c.radius_bottom >= c.radius_top ? PART_BOTTOM : PART_TOP;
  precise float z = dot3(from_center, c.axis);
  precise vec3 radial = from_center - z * c.axis;
  precise float foot = z + side.slope * length3(radial);
  return foot <= -c.half_height ? PART_BOTTOM : (foot >= c.half_height ? PART_TOP : PART_SIDE);
}

SurfacePoint capsule_surface(Ray ray, Primitive p, Hit hit) {
  Capsule c = capsule_of(p);
  Frustum side = side_of(c, vec3(0.0));
  precise vec3 from_center = (ray.origin - c.center) + hit.t * ray.direction;
  uint part = capsule_part(c, side, from_center);
  precise vec3 position;
  vec3 normal;
  if (part == PART_SIDE) {
    precise vec3 middle = c.side_middle * c.axis;
    precise vec3 from_middle = from_center - middle;
    SideOrCap found = on_frustum(side, from_middle, PART_SIDE, ray.direction);
    normal = found.normal;
    position = c.center + (middle + found.offset);
  } else {
    bool is_top = part == PART_TOP;
    float radius = is_top ? c.radius_top : c.radius_bottom;
    precise vec3 end = (is_top ? c.half_height : -c.half_height) * c.axis;
    precise vec3 from_end = from_center - end;
    normal = normalize3(from_end);
    position = c.center + (end + radius * normal);
  }
  float size = c.half_height + max(c.radius_bottom, c.radius_top);
  precise float lift = UNIT_ROUNDOFF * (8.0 * max_abs(position) + 16.0 * size);
  return SurfacePoint(position, normal, lift);
}
