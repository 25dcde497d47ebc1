// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// (P - point) . normal = 0. This is the point form, because n . p = D loses all accuracy far from the origin. The bound
// is |dt n.d| <= 8 u (|q - o| + |t d|); the largest factor measured is 1.7, at 1e5 with cosines 1...1e-6 (hard case
// 10).

vec3 plane_point(Primitive p) { return p.a.xyz; }
vec3 plane_normal(Primitive p) { return p.b.xyz; }

Crossing intersect_plane(Ray ray, Primitive p) {
  vec3 normal = plane_normal(p);
  precise float t = dot3(normal, plane_point(p) - ray.origin) / dot3(normal, ray.direction);
  // For a ray parallel to the plane, t is infinite or NaN here, and the ray misses.
  if (!(t > ray.tmin && t < INFINITY)) return NO_CROSSING;
  return Crossing(t, 0.0, 0.0, PART_SIDE);
}

// Computes the hit point and its lift. Only the error perpendicular to the plane matters, which is very small for an
// axis-aligned plane. According to a running error analysis, the error of n.(position - point) is at most u sum |n_i|
// (4 |from_point_i| + |position_i|), and rounding the lifted origin adds up to |position_i| again.
SurfacePoint plane_surface(Ray ray, Primitive p, Hit hit) {
  vec3 normal = plane_normal(p);
  precise vec3 along_ray = ray.origin + hit.t * ray.direction;
  precise vec3 from_point = along_ray - plane_point(p);
  precise vec3 position = along_ray - dot3(normal, from_point) * normal;
  precise float lift = UNIT_ROUNDOFF * dot3(abs(normal), 5.0 * abs(from_point) + 3.0 * abs(position));
  return SurfacePoint(position, normal, lift);
}
