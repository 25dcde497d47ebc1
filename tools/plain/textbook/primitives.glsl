// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The intersections of the textbook (docs/model.md), as written there, in world space and without care for rounding:
// what promin's own are measured against. With RECENTRED the ray starts at its closest approach to the primitive, which
// is half of what promin's do; with FP64 all is computed in double.

#ifdef FP64
#define real double
#define real2 dvec2
#define real3 dvec3
#define real3x3 dmat3
#else
#define real float
#define real2 vec2
#define real3 vec3
#define real3x3 mat3
#endif

struct SurfacePoint {
  vec3 position;
  vec3 normal;
  float lift;
};

vec3 corner0(Primitive p) { return p.a.xyz; }
vec3 corner1(Primitive p) { return vec3(p.a.w, p.b.xy); }
vec3 corner2(Primitive p) { return vec3(p.b.zw, uintBitsToFloat(p.c.x)); }
vec3 triangle_normal(Primitive p) { return normalize(cross(corner1(p) - corner0(p), corner2(p) - corner0(p))); }

// The ray's origin from `center`; with RECENTRED moved along the ray by the t that is returned.
real recentre(Ray ray, vec3 center, out real3 origin) {
  real3 direction = real3(ray.direction);
  origin = real3(ray.origin) - real3(center);
#ifdef RECENTRED
  real t = -dot(origin, direction) / dot(direction, direction);
  origin += t * direction;
  return t;
#else
  return real(0.0);
#endif
}

// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
Crossing intersect_triangle(Ray ray, Primitive p) {
  real3 direction = real3(ray.direction);
  real3 edge1 = real3(corner1(p)) - real3(corner0(p));
  real3 edge2 = real3(corner2(p)) - real3(corner0(p));
  real3 s;
  real start = recentre(ray, corner0(p), s);
  real3 h = cross(direction, edge2);
  real inverse = 1.0 / dot(edge1, h);
  real u = inverse * dot(s, h);
  real3 q = cross(s, edge1);
  real v = inverse * dot(direction, q);
  if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0)) return NO_CROSSING;
  return Crossing(float(start + inverse * dot(edge2, q)), float(u), float(v), PART_SIDE);
}

// The roots of a t^2 + 2 b t + c.
real2 solve(real a, real b, real c) {
  real root = sqrt(b * b - a * c);
  return real2(-b - root, -b + root) / a;
}

Crossing intersect_sphere(Ray ray, Primitive p) {
  real3 direction = real3(ray.direction);
  real3 oc;
  real start = recentre(ray, p.a.xyz, oc);
  real radius = real(p.a.w);
  real2 t = start + solve(dot(direction, direction), dot(direction, oc), dot(oc, oc) - radius * radius);
  return Crossing(float(t.x > ray.tmin ? t.x : t.y), 0.0, 0.0, PART_SIDE);
}

// n . p = D: the form that needs no point of the plane.
Crossing intersect_plane(Ray ray, Primitive p) {
  real3 normal = real3(p.b.xyz);
#ifdef RECENTRED
  real3 from_point;
  real start = recentre(ray, p.a.xyz, from_point);
  real t = start - dot(normal, from_point) / dot(normal, real3(ray.direction));
#else
  real t = (dot(normal, real3(p.a.xyz)) - dot(normal, real3(ray.origin))) / dot(normal, real3(ray.direction));
#endif
  return t < INFINITY ? Crossing(float(t), 0.0, 0.0, PART_SIDE) : NO_CROSSING;
}

void keep_nearer(Ray ray, real t, uint part, bool is_there, inout Crossing nearest) {
  if (is_there && t > ray.tmin && (nearest.t < 0.0 || t < nearest.t)) nearest = Crossing(float(t), 0.0, 0.0, part);
}

// |P - C - m V| = r + s m between two disks; the thesis' cylinder with s = 0, its cone with one radius 0.
Crossing intersect_frustum(Ray ray, vec3 center, vec3 given_axis, real half_height, real bottom, real top,
                           bool is_open) {
  real3 direction = real3(ray.direction);
  real3 axis = real3(given_axis);
  real s = (top - bottom) / (2.0 * half_height);
  real r = 0.5 * (bottom + top);
  real3 oc;
  real start = recentre(ray, center, oc);
  real dv = dot(direction, axis);
  real ov = dot(oc, axis);
  real w = r + s * ov;
  real a = dot(direction, direction) - (1.0 + s * s) * dv * dv;
  real b = dot(direction, oc) - dv * ov - s * w * dv;
  real c = dot(oc, oc) - ov * ov - w * w;
  real2 t = solve(a, b, c);
  Crossing nearest = NO_CROSSING;
  for (int i = 0; i < 2; ++i) {
    keep_nearer(ray, start + t[i], PART_SIDE, abs(ov + t[i] * dv) <= half_height, nearest);
  }
  for (int i = 0; i < 2 && !is_open; ++i) {
    real height = i == 0 ? -half_height : half_height;
    real radius = i == 0 ? bottom : top;
    real t_cap = (height - ov) / dv;
    real3 radial = oc + t_cap * direction - height * axis;
    keep_nearer(ray, start + t_cap, i == 0 ? PART_BOTTOM : PART_TOP, dot(radial, radial) <= radius * radius, nearest);
  }
  return nearest;
}

Crossing intersect_cylinder(Ray ray, Primitive p) {
  return intersect_frustum(ray, p.a.xyz, p.b.xyz, real(p.b.w), real(p.a.w), real(p.a.w),
                           p.c.x != 0u);
}

float cone_top(Primitive p) { return uintBitsToFloat(p.c.x & ~SHAPE_IS_OPEN); }

Crossing intersect_cone(Ray ray, Primitive p) {
  return intersect_frustum(ray, p.a.xyz, p.b.xyz, real(p.b.w), real(p.a.w), real(cone_top(p)),
                           (p.c.x & SHAPE_IS_OPEN) != 0u);
}

// Slabs, in the frame that the rotation matrix of the box's quaternion leads to.
real3x3 box_axes(Primitive p) {
  real3 q = real3(p.b.zw, uintBitsToFloat(p.c.x));
  real w = sqrt(1.0 - dot(q, q));
  return real3x3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + w * q.z), 2.0 * (q.x * q.z - w * q.y),
                 2.0 * (q.x * q.y - w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + w * q.x),
                 2.0 * (q.x * q.z + w * q.y), 2.0 * (q.y * q.z - w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
}

Crossing intersect_box(Ray ray, Primitive p) {
  real3x3 axes = box_axes(p);
  real3 half_size = real3(p.a.w, p.b.xy);
  real3 oc;
  real start = recentre(ray, p.a.xyz, oc);
  real near = real(-INFINITY);
  real far = real(INFINITY);
  uint near_face = 0u;
  uint far_face = 0u;
  for (int i = 0; i < 3; ++i) {
    real3 axis = axes[i];
    real d = dot(real3(ray.direction), axis);
    real o = dot(oc, axis);
    real low = (-half_size[i] - o) / d;
    real high = (half_size[i] - o) / d;
    uint face = 2u * uint(i);
    if (min(low, high) > near) near_face = face + (low < high ? 0u : 1u);
    if (max(low, high) < far) far_face = face + (low < high ? 1u : 0u);
    near = max(near, min(low, high));
    far = min(far, max(low, high));
  }
  if (!(near <= far)) return NO_CROSSING;
  bool takes_near = float(start + near) > ray.tmin;
  return Crossing(float(start + (takes_near ? near : far)), 0.0, 0.0, takes_near ? near_face : far_face);
}

// Both spheres, and the cone that touches them between the circles where it does.
Crossing intersect_capsule(Ray ray, Primitive p) {
  real3 direction = real3(ray.direction);
  real3 axis = real3(p.b.xyz);
  real half_height = real(p.b.w);
  real bottom = real(p.a.w);
  real top = real(uintBitsToFloat(p.c.x));
  real3 oc;
  real start = recentre(ray, p.a.xyz, oc);
  Crossing nearest = NO_CROSSING;
  bool has_side = 2.0 * half_height > abs(bottom - top);
  real s = has_side ? (bottom - top) / (2.0 * half_height) : real(bottom > top ? 1e30 : -1e30);
  for (int i = 0; i < 4; ++i) {
    bool is_top = i >= 2;
    real r = is_top ? top : bottom;
    real3 o = is_top ? oc - half_height * axis : oc + half_height * axis;
    real t = solve(dot(direction, direction), dot(direction, o), dot(o, o) - r * r)[i % 2];
    real along = dot(o + t * direction, axis);
    keep_nearer(ray, start + t, is_top ? PART_TOP : PART_BOTTOM, r > 0.0 && (is_top ? along >= s * r : along <= s * r),
                nearest);
  }
  if (!has_side) return nearest;
  real3 o = oc + half_height * axis;
  real k = 1.0 / (1.0 - s * s);
  real dv = dot(direction, axis);
  real ov = dot(o, axis);
  real w = bottom - s * ov;
  real2 t = solve(dot(direction, direction) - dv * dv - s * s * dv * dv * k,
                  dot(direction, o) - dv * ov + s * dv * w * k, dot(o, o) - ov * ov - w * w * k);
  for (int i = 0; i < 2; ++i) {
    real m = ov + t[i] * dv;
    keep_nearer(ray, start + t[i], PART_SIDE, m >= s * bottom && m <= 2.0 * half_height + s * top, nearest);
  }
  return nearest;
}

SurfacePoint surface_point(Ray ray, Primitive p, Hit hit) {
  vec3 position = ray.origin + hit.t * ray.direction;
  vec3 from_center = position - p.a.xyz;
  vec3 normal = p.b.xyz;
  if (p.c.z == KIND_TRIANGLE) normal = cross(corner1(p) - corner0(p), corner2(p) - corner0(p));
  if (p.c.z == KIND_SPHERE) normal = from_center;
  if (p.c.z == KIND_CYLINDER || p.c.z == KIND_CONE) {
    float slope = p.c.z == KIND_CONE ? (cone_top(p) - p.a.w) / (2.0 * p.b.w) : 0.0;
    vec3 radial = from_center - dot(from_center, p.b.xyz) * p.b.xyz;
    if (hit.part == PART_SIDE) normal = normalize(radial) - slope * p.b.xyz;
    if (hit.part == PART_BOTTOM) normal = -p.b.xyz;
  }
  if (p.c.z == KIND_CAPSULE) {
    float top = uintBitsToFloat(p.c.x);
    float s = (p.a.w - top) / (2.0 * p.b.w);
    vec3 radial = from_center - dot(from_center, p.b.xyz) * p.b.xyz;
    if (hit.part == PART_SIDE) normal = normalize(radial) + s / sqrt(1.0 - s * s) * p.b.xyz;
    if (hit.part == PART_BOTTOM) normal = from_center + p.b.w * p.b.xyz;
    if (hit.part == PART_TOP) normal = from_center - p.b.w * p.b.xyz;
  }
  if (p.c.z == KIND_BOX) normal = ((hit.part & 1u) != 0u ? 1.0 : -1.0) * mat3(box_axes(p))[hit.part / 2u];
  return SurfacePoint(position, normalize(normal), 1e-4);
}
