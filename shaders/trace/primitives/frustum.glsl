// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Cylinder and cone share the solid |radial| <= radius + slope * z, |z| <= half height, around an axis through its
// centre. It is convex, so a ray is inside it in one interval: the intersection of the interval of the two cap planes
// with that of the lateral surface. An end of the interval that lies on both a cap and the side belongs to one of them,
// so rays cannot pass through a rim. On an open solid the ray hits those ends of the interval that the side bounds; a
// rim then belongs to the side.
#ifndef FRUSTUM_GLSL
#define FRUSTUM_GLSL

struct Frustum {
  vec3 center;
  vec3 axis;
  float half_height;
  float radius;  // radius at the centre
  float slope;   // change of the radius per height; 0 for a cylinder
  bool is_open;  // whether it has only the side and no ends; false if the scene has no open shape
};

// The rounding error of z, as a multiple of the solid's size.
const float SLAB_DOUBT = 8.0 * UNIT_ROUNDOFF;

bool is_frustum_open(Primitive p) { return has(FEATURE_OPEN_SHAPES) && (p.c.x & SHAPE_IS_OPEN) != 0u; }

// Returns the interval inside a frustum. The method is that of Haines et al., Ray Tracing Gems ch. 7, with two changes
// of the origin: to the closest approach to the centre, then to a point of the ray near axis and apex. o + t d lies
// within 4.1 u S of the surface (measured over 9e6 rays; docs/accuracy.md, BK), also through apexes and along
// generators. Results differ from the exact one only within 0.92 u S of an edge (B2). This largest distance was found
// for a view along a needle from far away (row 54).
Inside inside_frustum(Ray ray, Approach near, Frustum f) {
  float scale = power_of_two_inverse(max(f.half_height, f.radius));
  precise vec3 offset = near.offset * scale;
  precise float half_height = f.half_height * scale;
  precise float radius = f.radius * scale;
  precise float dz = dot3(ray.direction, f.axis);
  precise vec3 radial_direction = ray.direction - dz * f.axis;
  precise float radial2 = dot3(radial_direction, radial_direction);

  // Computes the slab between the caps. A ray perpendicular to the axis hits its planes at +-infinity, or nowhere.
  float safe_dz = abs(dz) < TWO_POW_MINUS_80 ? (dz < 0.0 ? -TWO_POW_MINUS_80 : TWO_POW_MINUS_80) : dz;
  precise float inverse_dz = 1.0 / safe_dz;
  float entry_z = dz < 0.0 ? half_height : -half_height;
  precise float z = dot3(offset, f.axis);
  precise float slab_entry = (entry_z - z) * inverse_dz;
  precise float slab_exit = (-entry_z - z) * inverse_dz;
  uint entry_cap = dz < 0.0 ? PART_TOP : PART_BOTTOM;
  uint exit_cap = dz < 0.0 ? PART_BOTTOM : PART_TOP;

  // The quadratic is solved from the point in the slab that is nearest to axis and apex, where distance^2 + radius^2 is
  // smallest. There the rounding errors of these two are small compared with their values at the hit. At other points,
  // for a ray along a generator or along the axis near an apex, the errors would be large compared with the radius at
  // the hit.
  precise vec3 radial_offset = offset - z * f.axis;
  precise float widening = f.slope * dz;  // growth of the solid's radius per t along the ray
  precise float spread2 = radial2 + widening * widening;
  precise float widest = radius + abs(f.slope) * half_height;
  precise float inward = -(dot3(radial_offset, radial_direction) + (radius + f.slope * z) * widening);
  precise float t_nearest = spread2 > 0.0 ? inward / spread2 : 0.0;
  // The slab's ends have the same relative error as z. For a ray in the plane of an apex they may lie anywhere on the
  // ray.
  precise float doubt = SLAB_DOUBT * (half_height + widest) * abs(inverse_dz);
  precise float t_base = min(max(t_nearest, slab_entry - doubt), slab_exit + doubt);
  // Inside the solid, distance^2 + radius^2 is at most twice the largest radius^2. It has increased by spread2 t^2
  // since t_nearest. The limit is doubled to allow for rounding. A ray that enters the slab farther away, for example
  // just beyond a rim in its plane, is not in the solid. A solution from there, where rounding dominates, could put the
  // ray inside at any t.
  precise float way = t_base - t_nearest;
  precise float growth = spread2 * way * way;
  precise float most_growth = 4.0 * widest * widest;
  if (growth > most_growth) return NOWHERE;
  precise vec3 base = offset + t_base * ray.direction;
  precise float base_z = dot3(base, f.axis);
  precise vec3 base_radial = base - base_z * f.axis;
  precise float base_distance = length3(base_radial);
  precise float base_radius = radius + f.slope * base_z;

  // |radial(t)|^2 - radius(t)^2 = a t^2 + 2 b t + c, where t counts from t_base.
  precise float a = radial2 - widening * widening;
  precise float b = dot3(base_radial, radial_direction) - base_radius * widening;
  precise float c = (base_distance - base_radius) * (base_distance + base_radius);
  precise float discriminant = b * b - a * c;
  float side_entry = -INFINITY;
  float side_exit = INFINITY;
  if (spread2 > 0.0) {
    if (a > 0.0 && !is_interval(0.0, discriminant)) return NOWHERE;
    precise float root = sqrt(max(discriminant, 0.0));
    precise float q = b < 0.0 ? root - b : -(b + root);
    precise float t0 = c / q;
    precise float t1 = q / a;
    if (q == 0.0) t0 = 0.0;
    if (a > 0.0) {
      side_entry = min(t0, q == 0.0 ? 0.0 : t1);
      side_exit = max(t0, q == 0.0 ? 0.0 : t1);
    } else if (a < 0.0) {
      // The ray is steeper than the cone. It is inside from the root on the real nappe, in the direction in which the
      // cone widens. The other root lies on the mirror nappe, which the slab excludes.
      if (q == 0.0) t1 = 0.0;
      if (widening > 0.0) {
        side_entry = max(t0, t1);
      } else {
        side_exit = min(t0, t1);
      }
    } else if (b < 0.0) {
      // The ray is parallel to a generator. 2 b t + c has one root, on one of the nappes; the slab excludes the root on
      // the mirrored nappe.
      side_entry = t0;
    } else if (b > 0.0) {
      side_exit = t0;
    } else if (c > 0.0) {
      return NOWHERE;
    }
  } else if (!(base_distance <= base_radius)) {
    return NOWHERE;  // the ray is parallel to a cylinder's axis and outside it
  }

  // The caps are computed from the same base as the side. Rounding of base_z therefore moves the solid as a whole, and
  // a rim keeps its place at any angle.
  precise float cap_entry = (entry_z - base_z) * inverse_dz;
  precise float cap_exit = (-entry_z - base_z) * inverse_dz;
  bool enters_side = side_entry > cap_entry;
  bool exits_side = side_exit < cap_exit;
  if (has(FEATURE_OPEN_SHAPES) && f.is_open) {
    enters_side = side_entry >= cap_entry;
    exits_side = side_exit <= cap_exit;
  }
  float entry = enters_side ? side_entry : cap_entry;
  float exit = exits_side ? side_exit : cap_exit;
  if (!is_interval(entry, exit)) return NOWHERE;
  float unscale = 1.0 / scale;
  precise float t_entry = near.t_far + (near.t_near + (t_base + entry) * unscale);
  precise float t_exit = near.t_far + (near.t_near + (t_base + exit) * unscale);
  return Inside(t_entry, enters_side ? PART_SIDE : entry_cap, t_exit, exits_side ? PART_SIDE : exit_cap);
}

Crossing intersect_frustum(Ray ray, Frustum f) {
  Inside inside = inside_frustum(ray, approach(ray, f.center), f);
  if (has(FEATURE_OPEN_SHAPES) && f.is_open) {
    // A ray that enters through a missing disk counts as having always been inside.
    if (inside.entry_part != PART_SIDE) inside.entry = -INFINITY;
    Crossing nearest = nearest_crossing(ray, inside);
    if (nearest.part == PART_SIDE) return nearest;
    return NO_CROSSING;
  }
  return nearest_crossing(ray, inside);
}

Inside ends_of_frustum(Ray ray, Frustum f) {
  Inside inside = inside_frustum(ray, approach(ray, f.center), f);
  if (has(FEATURE_OPEN_SHAPES) && f.is_open) {
    if (inside.entry_part != PART_SIDE) inside.entry = -INFINITY;
    if (inside.exit_part != PART_SIDE) inside.exit = INFINITY;
  }
  return inside;
}

// A point of the surface relative to the centre, and its normal.
struct SideOrCap {
  vec3 offset;
  vec3 normal;
};

SideOrCap on_frustum(Frustum f, vec3 from_center, uint part, vec3 direction) {
  precise float z = dot3(from_center, f.axis);
  precise vec3 radial = from_center - z * f.axis;
  precise vec3 offset;
  vec3 normal;
  if (part == PART_SIDE) {
    vec3 outward = normalize3(radial);
    // At an apex, and if u S is as large as the radius, rounding may leave no radial direction. The normal is then the
    // axis or, on a cylinder, the direction back along the ray.
    precise vec3 across = cross3(f.axis, outward);
    bool is_lost = dot3(across, across) < 0.5;
    if (is_lost) outward = vec3(0.0);
    precise vec3 slanted = outward - f.slope * f.axis;
    normal = normalize3(is_lost && f.slope == 0.0 ? -direction : slanted);
    offset = z * f.axis + (f.radius + f.slope * z) * outward;
  } else {
    normal = part == PART_TOP ? f.axis : -f.axis;
    precise float cap_z = part == PART_TOP ? f.half_height : -f.half_height;
    offset = cap_z * f.axis + radial;
  }
  return SideOrCap(offset, normal);
}

SurfacePoint frustum_surface(Ray ray, Frustum f, Hit hit) {
  precise vec3 from_center = (ray.origin - f.center) + hit.t * ray.direction;
  SideOrCap found = on_frustum(f, from_center, hit.part, ray.direction);
  precise vec3 position = f.center + found.offset;
  float size = f.half_height + f.radius + abs(f.slope) * f.half_height;
  precise float lift = UNIT_ROUNDOFF * (8.0 * max_abs(position) + 16.0 * size);
  return SurfacePoint(position, found.normal, lift);
}
#endif
