// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The intersections of the textbook (docs/model.md), as written there, in world space and without care for rounding:
// what promin's own are measured against.

struct SurfacePoint {
  vec3 position;
  vec3 normal;
  float lift;
};

vec3 corner0(Primitive p) { return p.a.xyz; }
vec3 corner1(Primitive p) { return vec3(p.a.w, p.b.xy); }
vec3 corner2(Primitive p) { return vec3(p.b.zw, uintBitsToFloat(p.c.x)); }

// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
Crossing intersect_triangle(Ray ray, Primitive p) {
  vec3 edge1 = corner1(p) - corner0(p);
  vec3 edge2 = corner2(p) - corner0(p);
  vec3 h = cross(ray.direction, edge2);
  float inverse = 1.0 / dot(edge1, h);
  vec3 s = ray.origin - corner0(p);
  float u = inverse * dot(s, h);
  vec3 q = cross(s, edge1);
  float v = inverse * dot(ray.direction, q);
  if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0)) return NO_CROSSING;
  return Crossing(inverse * dot(edge2, q), u, v, PART_SIDE);
}

// The nearer root above tmin of a t^2 + 2 b t + c.
vec2 solve(float a, float b, float c) {
  float root = sqrt(b * b - a * c);
  return vec2(-b - root, -b + root) / a;
}

Crossing intersect_sphere(Ray ray, Primitive p) {
  vec3 oc = ray.origin - p.a.xyz;
  vec2 t = solve(dot(ray.direction, ray.direction), dot(ray.direction, oc), dot(oc, oc) - p.a.w * p.a.w);
  return Crossing(t.x > ray.tmin ? t.x : t.y, 0.0, 0.0, PART_SIDE);
}

Crossing intersect_plane(Ray ray, Primitive p) {
  float t = (dot(p.b.xyz, p.a.xyz) - dot(p.b.xyz, ray.origin)) / dot(p.b.xyz, ray.direction);
  return t < INFINITY ? Crossing(t, 0.0, 0.0, PART_SIDE) : NO_CROSSING;
}

void keep_nearer(Ray ray, float t, uint part, bool is_there, inout Crossing nearest) {
  if (is_there && t > ray.tmin && (nearest.t < 0.0 || t < nearest.t)) nearest = Crossing(t, 0.0, 0.0, part);
}

// |P - C - m V| = r + s m between two disks; the thesis' cylinder with s = 0, its cone with one radius 0.
Crossing intersect_frustum(Ray ray, vec3 center, vec3 axis, float half_height, float bottom, float top) {
  float s = (top - bottom) / (2.0 * half_height);
  float r = 0.5 * (bottom + top);
  vec3 oc = ray.origin - center;
  float dv = dot(ray.direction, axis);
  float ov = dot(oc, axis);
  float w = r + s * ov;
  float a = dot(ray.direction, ray.direction) - (1.0 + s * s) * dv * dv;
  float b = dot(ray.direction, oc) - dv * ov - s * w * dv;
  float c = dot(oc, oc) - ov * ov - w * w;
  vec2 t = solve(a, b, c);
  Crossing nearest = NO_CROSSING;
  for (int i = 0; i < 2; ++i) keep_nearer(ray, t[i], PART_SIDE, abs(ov + t[i] * dv) <= half_height, nearest);
  for (int i = 0; i < 2; ++i) {
    float height = i == 0 ? -half_height : half_height;
    float radius = i == 0 ? bottom : top;
    float t_cap = (height - ov) / dv;
    vec3 radial = oc + t_cap * ray.direction - height * axis;
    keep_nearer(ray, t_cap, i == 0 ? PART_BOTTOM : PART_TOP, dot(radial, radial) <= radius * radius, nearest);
  }
  return nearest;
}

Crossing intersect_cylinder(Ray ray, Primitive p) {
  return intersect_frustum(ray, p.a.xyz, p.b.xyz, p.b.w, p.a.w, p.a.w);
}

Crossing intersect_cone(Ray ray, Primitive p) {
  return intersect_frustum(ray, p.a.xyz, p.b.xyz, p.b.w, p.a.w, uintBitsToFloat(p.c.x));
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
