// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The intersections of the textbook (docs/model.md), as written there, in world space and without care for rounding.
// promin's own methods are compared with them.

struct SurfacePoint {
  vec3 position;
  vec3 normal;
  float lift;
};

vec3 corner0(Primitive p) { return p.a.xyz; }
vec3 corner1(Primitive p) { return vec3(p.a.w, p.b.xy); }
vec3 corner2(Primitive p) { return vec3(p.b.zw, uintBitsToFloat(p.c.x)); }
vec3 triangle_normal(Primitive p) { return normalize(cross(corner1(p) - corner0(p), corner2(p) - corner0(p))); }

// The method is that of Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
Crossing intersect_triangle(Ray ray, Primitive p) {
  vec3 direction = ray.direction;
  vec3 edge1 = corner1(p) - corner0(p);
  vec3 edge2 = corner2(p) - corner0(p);
  vec3 s = ray.origin - corner0(p);
  vec3 h = cross(direction, edge2);
  float inverse = 1.0 / dot(edge1, h);
  float u = inverse * dot(s, h);
  vec3 q = cross(s, edge1);
  float v = inverse * dot(direction, q);
  if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0)) return NO_CROSSING;
  return Crossing(inverse * dot(edge2, q), u, v, PART_SIDE);
}

// Returns the roots of a t^2 + 2 b t + c.
vec2 solve(float a, float b, float c) {
  float root = sqrt(b * b - a * c);
  return vec2(-b - root, -b + root) / a;
}

Crossing intersect_sphere(Ray ray, Primitive p) {
  vec3 direction = ray.direction;
  vec3 oc = ray.origin - p.a.xyz;
  float radius = p.a.w;
  vec2 t = solve(dot(direction, direction), dot(direction, oc), dot(oc, oc) - radius * radius);
  return Crossing(t.x > ray.tmin ? t.x : t.y, 0.0, 0.0, PART_SIDE);
}

// Solves n . p = D, the form that needs no point of the plane.
Crossing intersect_plane(Ray ray, Primitive p) {
  vec3 normal = p.b.xyz;
  float t = (dot(normal, p.a.xyz) - dot(normal, ray.origin)) / dot(normal, ray.direction);
  return t < INFINITY ? Crossing(t, 0.0, 0.0, PART_SIDE) : NO_CROSSING;
}

void keep_nearer(Ray ray, float t, uint part, bool is_there, inout Crossing nearest) {
  if (is_there && t > ray.tmin && (nearest.t < 0.0 || t < nearest.t)) nearest = Crossing(t, 0.0, 0.0, part);
}

// Solves |P - C - m V| = r + s m between two disks; s = 0 gives the thesis' cylinder, one radius of 0 its cone.
Crossing intersect_frustum(Ray ray, vec3 center, vec3 axis, float half_height, float bottom, float top, bool is_open) {
  vec3 direction = ray.direction;
  float s = (top - bottom) / (2.0 * half_height);
  float r = 0.5 * (bottom + top);
  vec3 oc = ray.origin - center;
  float dv = dot(direction, axis);
  float ov = dot(oc, axis);
  float w = r + s * ov;
  float a = dot(direction, direction) - (1.0 + s * s) * dv * dv;
  float b = dot(direction, oc) - dv * ov - s * w * dv;
  float c = dot(oc, oc) - ov * ov - w * w;
  vec2 t = solve(a, b, c);
  Crossing nearest = NO_CROSSING;
  for (int i = 0; i < 2; ++i) {
    keep_nearer(ray, t[i], PART_SIDE, abs(ov + t[i] * dv) <= half_height, nearest);
  }
  for (int i = 0; i < 2 && !is_open; ++i) {
    float height = i == 0 ? -half_height : half_height;
    float radius = i == 0 ? bottom : top;
    float t_cap = (height - ov) / dv;
    vec3 radial = oc + t_cap * direction - height * axis;
    keep_nearer(ray, t_cap, i == 0 ? PART_BOTTOM : PART_TOP, dot(radial, radial) <= radius * radius, nearest);
  }
  return nearest;
}

Crossing intersect_cylinder(Ray ray, Primitive p) {
  return intersect_frustum(ray, p.a.xyz, p.b.xyz, p.b.w, p.a.w, p.a.w, p.c.x != 0u);
}

float cone_top(Primitive p) { return uintBitsToFloat(p.c.x & ~SHAPE_IS_OPEN); }

Crossing intersect_cone(Ray ray, Primitive p) {
  return intersect_frustum(ray, p.a.xyz, p.b.xyz, p.b.w, p.a.w, cone_top(p), (p.c.x & SHAPE_IS_OPEN) != 0u);
}

// Tests slabs in the box's frame. The columns of the quaternion's rotation matrix are the axes of this frame.
mat3 box_axes(Primitive p) {
  vec3 q = vec3(p.b.zw, uintBitsToFloat(p.c.x));
  float w = sqrt(1.0 - dot(q, q));
  return mat3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + w * q.z), 2.0 * (q.x * q.z - w * q.y),
              2.0 * (q.x * q.y - w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + w * q.x),
              2.0 * (q.x * q.z + w * q.y), 2.0 * (q.y * q.z - w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
}

Crossing intersect_box(Ray ray, Primitive p) {
  mat3 axes = box_axes(p);
  vec3 half_size = vec3(p.a.w, p.b.xy);
  vec3 oc = ray.origin - p.a.xyz;
  float near = -INFINITY;
  float far = INFINITY;
  uint near_face = 0u;
  uint far_face = 0u;
  for (int i = 0; i < 3; ++i) {
    vec3 axis = axes[i];
    float d = dot(ray.direction, axis);
    float o = dot(oc, axis);
    float low = (-half_size[i] - o) / d;
    float high = (half_size[i] - o) / d;
    uint face = 2u * uint(i);
    if (min(low, high) > near) near_face = face + (low < high ? 0u : 1u);
    if (max(low, high) < far) far_face = face + (low < high ? 1u : 0u);
    near = max(near, min(low, high));
    far = min(far, max(low, high));
  }
  if (!(near <= far)) return NO_CROSSING;
  bool takes_near = near > ray.tmin;
  return Crossing(takes_near ? near : far, 0.0, 0.0, takes_near ? near_face : far_face);
}

// Tests both spheres, and the cone between the circles where it touches them.
Crossing intersect_capsule(Ray ray, Primitive p) {
  vec3 direction = ray.direction;
  vec3 axis = p.b.xyz;
  float half_height = p.b.w;
  float bottom = p.a.w;
  float top = uintBitsToFloat(p.c.x);
  vec3 oc = ray.origin - p.a.xyz;
  Crossing nearest = NO_CROSSING;
  bool has_side = 2.0 * half_height > abs(bottom - top);
  float s = has_side ? (bottom - top) / (2.0 * half_height) : (bottom > top ? 1e30 : -1e30);
  for (int i = 0; i < 4; ++i) {
    bool is_top = i >= 2;
    float r = is_top ? top : bottom;
    vec3 o = is_top ? oc - half_height * axis : oc + half_height * axis;
    float t = solve(dot(direction, direction), dot(direction, o), dot(o, o) - r * r)[i % 2];
    float along = dot(o + t * direction, axis);
    keep_nearer(ray, t, is_top ? PART_TOP : PART_BOTTOM, r > 0.0 && (is_top ? along >= s * r : along <= s * r),
                nearest);
  }
  if (!has_side) return nearest;
  vec3 o = oc + half_height * axis;
  float k = 1.0 / (1.0 - s * s);
  float dv = dot(direction, axis);
  float ov = dot(o, axis);
  float w = bottom - s * ov;
  vec2 t = solve(dot(direction, direction) - dv * dv - s * s * dv * dv * k,
                 dot(direction, o) - dv * ov + s * dv * w * k, dot(o, o) - ov * ov - w * w * k);
  for (int i = 0; i < 2; ++i) {
    float m = ov + t[i] * dv;
    keep_nearer(ray, t[i], PART_SIDE, m >= s * bottom && m <= 2.0 * half_height + s * top, nearest);
  }
  return nearest;
}

#include "trace/instances.glsl"

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
  if (p.c.z == KIND_BOX) normal = ((hit.part & 1u) != 0u ? 1.0 : -1.0) * box_axes(p)[hit.part / 2u];
  return SurfacePoint(position, normalize(normal), 1e-4);
}
