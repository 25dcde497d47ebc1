// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// (P - point) . normal = 0. The point form: n . p = D loses everything far from the origin (numerics.md).
// |dt n.d| <= 8 u (|q - o| + |t d|); at most 1.7 measured at 1e5, cosines 1...1e-6 (hard case 10).

Crossing intersect_plane(Ray ray, Primitive p) {
  precise float t = dot3(p.b.xyz, p.a.xyz - ray.origin) / dot3(p.b.xyz, ray.direction);
  // A parallel ray brings an infinity or NaN here, and misses.
  if (!(t > ray.tmin && t < INFINITY)) return NO_CROSSING;
  return Crossing(t, 0.0, 0.0, PART_SIDE);
}

SurfacePoint plane_surface(Ray ray, Primitive p, Hit hit) {
  precise vec3 along_ray = ray.origin + hit.t * ray.direction;
  precise vec3 from_point = along_ray - p.a.xyz;
  precise vec3 position = along_ray - dot3(p.b.xyz, from_point) * p.b.xyz;
  precise float lift = 8.0 * UNIT_ROUNDOFF * (max_abs(position) + max_abs(from_point));
  return SurfacePoint(position, p.b.xyz, lift);
}
