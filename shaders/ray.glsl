// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Rays as the intersections want them, and hits as they give them.

struct Ray {
  vec3 origin;
  vec3 direction;  // scaled by a power of two: its largest component is in [1, 2)
  float tmin;      // a hit has tmin < t < tmax, in units of the scaled direction
  float tmax;
  float inverse_length2;   // 1 / |direction|^2
  vec3 inverse_direction;  // finite: components under 2^-80 count as 2^-80 with their sign
  vec3 near_origin;        // origin, moved so that the slab test's near and far planes lie `padding` further out
  vec3 far_origin;
  uint shear_axis;  // where |direction| is largest
  vec3 shear;       // direction of the two other axes over the largest, and 1 / largest
};

// A hit, or what is known of the nearest so far: then t = tmax.
struct Hit {
  float t;
  float u;  // weights of a triangle's second and third corner
  float v;
  uint part;       // of an analytic shape: PART_*
  uint primitive;  // index into `primitives`; NO_PRIMITIVE on a miss
  uint order;      // scene-wide number: the lower wins at equal t
};

const uint NO_PRIMITIVE = 0xFFFFFFFFu;
const uint PART_SIDE = 0u;
const uint PART_BOTTOM = 1u;
const uint PART_TOP = 2u;

// Where a ray meets one primitive: the nearest t > tmin, or NO_CROSSING.
struct Crossing {
  float t;
  float u;
  float v;
  uint part;
};
const Crossing NO_CROSSING = Crossing(-1.0, 0.0, 0.0, PART_SIDE);

// Rotates axes so that `axis` comes last.
vec3 permute_axes(vec3 v, uint axis) { return axis == 0u ? v.yzx : (axis == 1u ? v.zxy : v); }

// The box test's allowance, as a multiple of the distance that intersections may span: every accepted hit lies within
// 8 u S of its primitive (numerics.md, BK), so a box grown by 16 u S never hides one, whatever the tree. Slivers of
// aspect beyond 1e2 are the exception: P(u,v) does, but t may be off by more (hard case 25).
const float BOX_PADDING = 16.0 * UNIT_ROUNDOFF;
// Twice what rounding can take of the padding when it is added to the origin: far from the world's origin that would be
// all of it, which lost 5 % of rays at edges and corners at 1e3 and 1e5 (hard case 28).
const float ORIGIN_PADDING = 2.0 * UNIT_ROUNDOFF;

// Whether all components are finite; by their bits, as a compiler may assume that there are no NaNs.
bool is_finite(vec3 v) {
  uvec3 exponents = floatBitsToUint(v) & 0x7F800000u;
  return all(notEqual(exponents, uvec3(0x7F800000u)));
}

bool is_nan(float x) { return (floatBitsToUint(x) & 0x7FFFFFFFu) > 0x7F800000u; }

// `direction` may have any length from 2^-126 up to below 2^127; `tmin` and `tmax` are in its units. Any other
// direction, NaN anywhere, tmin = +infinity and an origin beyond 10^38 give a ray that misses everything.
Ray make_ray(vec3 origin, vec3 direction, float tmin, float tmax) {
  Ray ray;
  float size = max_abs(direction);
  bool is_valid = is_finite(direction) && size >= 1.17549435e-38 && size < 1.7014118e+38 && is_finite(origin) &&
                  max_abs(origin) < 1e38 && !is_nan(tmin) && !is_nan(tmax) && tmin < tmax && tmin < INFINITY;
  float scale = is_valid ? power_of_two_inverse(size) : 1.0;
  ray.origin = is_valid ? origin : vec3(0.0);
  ray.direction = is_valid ? direction * scale : vec3(1.0, 0.0, 0.0);
  // t * direction is kept, so t grows by what the direction loses.
  float unscale = power_of_two_inverse(scale);
  precise float scaled_tmin = max(tmin, 0.0) * unscale;
  precise float scaled_tmax = tmax * unscale;
  ray.tmin = is_valid ? scaled_tmin : 1.0;
  ray.tmax = is_valid ? scaled_tmax : 0.0;

  precise float inverse_length2 = 1.0 / dot3(ray.direction, ray.direction);
  ray.inverse_length2 = inverse_length2;

  vec3 signs = vec3(ray.direction.x < 0.0 ? -1.0 : 1.0, ray.direction.y < 0.0 ? -1.0 : 1.0,
                    ray.direction.z < 0.0 ? -1.0 : 1.0);
  precise vec3 inverse_direction = 1.0 / (signs * max(abs(ray.direction), vec3(TWO_POW_MINUS_80)));
  ray.inverse_direction = inverse_direction;
  precise float reach = max_abs(ray.origin - frame.tree_bounds.xyz) + frame.tree_bounds.w;
  precise vec3 padding = signs * (BOX_PADDING * reach + ORIGIN_PADDING * abs(ray.origin));
  precise vec3 near_origin = ray.origin + padding;
  precise vec3 far_origin = ray.origin - padding;
  ray.near_origin = near_origin;
  ray.far_origin = far_origin;

  ray.shear_axis = 2u;
  ray.shear = vec3(0.0);
  if (has(FEATURE_TRIANGLES)) {
    vec3 a = abs(ray.direction);
    ray.shear_axis = a.x > a.y ? (a.x > a.z ? 0u : 2u) : (a.y > a.z ? 1u : 2u);
    vec3 d = permute_axes(ray.direction, ray.shear_axis);
    precise vec3 shear = vec3(d.x / d.z, d.y / d.z, 1.0 / d.z);
    ray.shear = shear;
  }
  return ray;
}

// A ray's closest approach to `center`: the point is center + offset, at t = t_far + t_near. The two parts of t are
// kept apart until the small one has met the half chord: that keeps the error at u * |t|. Haines et al., Ray Tracing
// Gems ch. 7, with one correction step more.
struct Approach {
  vec3 offset;
  float t_far;
  float t_near;
};

Approach approach(Ray ray, vec3 center) {
  precise vec3 from_center = ray.origin - center;
  precise float t_far = -dot3(from_center, ray.direction) * ray.inverse_length2;
  precise vec3 offset = from_center + t_far * ray.direction;
  precise float t_near = -dot3(offset, ray.direction) * ray.inverse_length2;
  precise vec3 corrected = offset + t_near * ray.direction;
  return Approach(corrected, t_far, t_near);
}

// Picks the nearest valid end of the interval in which a ray is inside a convex shape.
Crossing nearest_crossing(Ray ray, float entry, uint entry_part, float exit, uint exit_part) {
  if (!(entry <= exit)) return NO_CROSSING;
  bool takes_entry = entry > ray.tmin;
  return Crossing(takes_entry ? entry : exit, 0.0, 0.0, takes_entry ? entry_part : exit_part);
}
