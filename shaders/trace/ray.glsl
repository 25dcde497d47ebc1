// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Rays in the form for intersections (make_ray.glsl creates them), and hits as they return them.

struct Ray {
  vec3 origin;
  vec3 direction;  // scaled by a power of two: its largest component is in [1, 2)
  float tmin;      // a hit has tmin < t < tmax, in units of the scaled direction
  float tmax;
  float inverse_length2;   // 1 / |direction|^2
  vec3 inverse_direction;  // finite: components below 2^-60 count as 2^-60 with their sign
  vec3 near_origin;        // origin for the near planes of the slab test, moved so that near and far planes lie further
                           // out by the padding
  vec3 far_origin;
  uint shear_axis;  // axis along which |direction| is largest
  vec3 shear;       // the two other components of the direction divided by the largest, and 1 / largest
};

// A hit, or the state of the search for the nearest hit: initially t = tmax.
struct Hit {
  float t;
  float u;  // weights of a triangle's second and third corner
  float v;
  uint part;       // the face of an analytic shape that was hit: PART_*; in an instance, its number (instances.glsl)
  uint primitive;  // index into `primitives`; NO_PRIMITIVE on a miss
  uint order;      // number in the scene; at equal t the lower number wins
};

const uint NO_PRIMITIVE = 0xFFFFFFFFu;
const uint PART_SIDE = 0u;
const uint PART_BOTTOM = 1u;
const uint PART_TOP = 2u;

// The crossing of a ray with one primitive: the crossing with the smallest t > tmin, or NO_CROSSING.
struct Crossing {
  float t;
  float u;
  float v;
  uint part;
};
const Crossing NO_CROSSING = Crossing(-1.0, 0.0, 0.0, PART_SIDE);

// Rotates the axes so that `axis` becomes the last one.
vec3 permute_axes(vec3 v, uint axis) { return axis == 0u ? v.yzx : (axis == 1u ? v.zxy : v); }

// A ray's closest approach to `center`: the point is center + offset, at t = t_far + t_near. The two terms of t are
// added only after the small one has been combined with the half chord, which keeps the error at u * |t|. The
// method is that of Haines et al., Ray Tracing Gems ch. 7, with one more correction step.
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

// The interval of t in which a ray is inside a convex shape, with the part of the surface at each end. The interval is
// empty unless entry <= exit. In the ends of an open shape (ends_of_*), an end in the missing part is infinite.
struct Inside {
  float entry;
  uint entry_part;
  float exit;
  uint exit_part;
};
// True if the kernel finds all crossings (crossings.comp). Surfaces that a ray only touches do not count then.
#ifndef ASKS_FOR_ALL
#define ASKS_FOR_ALL false
#endif
bool is_interval(float begin, float end) { return ASKS_FOR_ALL ? begin < end : begin <= end; }
#define NOWHERE Inside(INFINITY, PART_SIDE, -INFINITY, PART_SIDE)

// Returns the nearest valid end of the interval in which a ray is inside a shape.
Crossing nearest_crossing(Ray ray, float entry, uint entry_part, float exit, uint exit_part) {
  if (!(entry <= exit)) return NO_CROSSING;
  bool takes_entry = entry > ray.tmin;
  return Crossing(takes_entry ? entry : exit, 0.0, 0.0, takes_entry ? entry_part : exit_part);
}

Crossing nearest_crossing(Ray ray, Inside inside) {
  return nearest_crossing(ray, inside.entry, inside.entry_part, inside.exit, inside.exit_part);
}

#include "trace/level.glsl"
