// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The intersections of the textbook (docs/model.md), as written there, in world space and without care for rounding:
// what promin's own are measured against. With RECENTRED the ray starts at its closest approach to the primitive, which
// is half of what promin's do; with FP64 all is computed in double.

#ifdef FP64
#define real double
#define real2 dvec2
#define real3 dvec3
#else
#define real float
#define real2 vec2
#define real3 vec3
#endif

struct SurfacePoint {
  vec3 position;
  vec3 normal;
  float lift;
};

vec3 corner0(Primitive p) { return p.a.xyz; }
vec3 corner1(Primitive p) { return vec3(p.a.w, p.b.xy); }
vec3 corner2(Primitive p) { return vec3(p.b.zw, uintBitsToFloat(p.c.x)); }

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
Crossing intersect_frustum(Ray ray, vec3 center, vec3 given_axis, real half_height, real bottom, real top) {
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
  for (int i = 0; i < 2; ++i) {
    real height = i == 0 ? -half_height : half_height;
    real radius = i == 0 ? bottom : top;
    real t_cap = (height - ov) / dv;
    real3 radial = oc + t_cap * direction - height * axis;
    keep_nearer(ray, start + t_cap, i == 0 ? PART_BOTTOM : PART_TOP, dot(radial, radial) <= radius * radius, nearest);
  }
  return nearest;
}

Crossing intersect_cylinder(Ray ray, Primitive p) {
  return intersect_frustum(ray, p.a.xyz, p.b.xyz, real(p.b.w), real(p.a.w), real(p.a.w));
}

Crossing intersect_cone(Ray ray, Primitive p) {
  return intersect_frustum(ray, p.a.xyz, p.b.xyz, real(p.b.w), real(p.a.w), real(uintBitsToFloat(p.c.x)));
}

SurfacePoint surface_point(Ray ray, Primitive p, Hit hit) {
  vec3 position = ray.origin + hit.t * ray.direction;
  vec3 from_center = position - p.a.xyz;
  vec3 normal = p.b.xyz;
  if (p.c.z == KIND_TRIANGLE) normal = cross(corner1(p) - corner0(p), corner2(p) - corner0(p));
  if (p.c.z == KIND_SPHERE) normal = from_center;
  if (p.c.z == KIND_CYLINDER || p.c.z == KIND_CONE) {
    float slope = p.c.z == KIND_CONE ? (uintBitsToFloat(p.c.x) - p.a.w) / (2.0 * p.b.w) : 0.0;
    vec3 radial = from_center - dot(from_center, p.b.xyz) * p.b.xyz;
    if (hit.part == PART_SIDE) normal = normalize(radial) - slope * p.b.xyz;
    if (hit.part == PART_BOTTOM) normal = -p.b.xyz;
  }
  return SurfacePoint(position, normalize(normal), 1e-4);
}
