// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The sphere |P - center| = radius is solved around the ray's closest approach to the centre, with the discriminant as
// (r - |p|)(r + |p|): |dt||d|cos <= 2.4 u (|o - c| + r) was measured (hard cases 1-9).

vec3 sphere_center(Primitive p) { return p.a.xyz; }
float sphere_radius(Primitive p) { return p.a.w; }

// Returns the square of half the chord in units of `scale`, a power of two near 1 / radius, so that nothing relevant
// overflows or underflows. The result is negative if there is no chord.
float chord_square(Ray ray, Approach near, float given_radius, float scale) {
  precise vec3 offset = near.offset * scale;
  precise float radius = given_radius * scale;
  precise float distance = length3(offset);
  precise float chord2 = (radius - distance) * (radius + distance) * ray.inverse_length2;
  return chord2;
}

Inside ends_of_sphere(Ray ray, Primitive p) {
  Approach near = approach(ray, sphere_center(p));
  float scale = power_of_two_inverse(sphere_radius(p));
  float chord2 = chord_square(ray, near, sphere_radius(p), scale);
  if (!is_interval(0.0, chord2)) return NOWHERE;
  precise float half_chord = sqrt(chord2) * (1.0 / scale);
  precise float entry = near.t_far + (near.t_near - half_chord);
  precise float exit = near.t_far + (near.t_near + half_chord);
  return Inside(entry, PART_SIDE, exit, PART_SIDE);
}

Crossing intersect_sphere(Ray ray, Primitive p) { return nearest_crossing(ray, ends_of_sphere(ray, p)); }

SurfacePoint sphere_surface(Ray ray, Primitive p, Hit hit) {
  precise vec3 from_center = (ray.origin - sphere_center(p)) + hit.t * ray.direction;
  vec3 normal = normalize3(from_center);
  precise vec3 position = sphere_center(p) + sphere_radius(p) * normal;
  precise float lift = UNIT_ROUNDOFF * (8.0 * max_abs(position) + 16.0 * sphere_radius(p));
  return SurfacePoint(position, normal, lift);
}
