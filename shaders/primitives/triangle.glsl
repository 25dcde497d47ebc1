// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2013: shear the triangle so that the ray runs
// along an axis, and compare products in 2D. Every triangle sees the same sheared vertex, so none leaks at a shared
// edge or vertex, as long as nothing is contracted. Measured: another answer than the exact one only within 0.6 u S of
// an edge (bound 2), |dt||d|cos <= 3.6 u S; of a sliver that grows to a tenth of its aspect, while P(u,v) stays within
// 0.7 u S of the plane (bound 8; hard cases 25, 29, 38).

vec3 corner0(Primitive p) { return p.a.xyz; }
vec3 corner1(Primitive p) { return vec3(p.a.w, p.b.xy); }
vec3 corner2(Primitive p) { return vec3(p.b.zw, uintBitsToFloat(p.c.x)); }

Crossing intersect_triangle(Ray ray, Primitive p) {
  precise vec3 a = permute_axes(corner0(p) - ray.origin, ray.shear_axis);
  precise vec3 b = permute_axes(corner1(p) - ray.origin, ray.shear_axis);
  precise vec3 c = permute_axes(corner2(p) - ray.origin, ray.shear_axis);
  precise vec2 a2 = a.xy - ray.shear.xy * a.z;
  precise vec2 b2 = b.xy - ray.shear.xy * b.z;
  precise vec2 c2 = c.xy - ray.shear.xy * c.z;

  // Each is the difference of two rounded products: its sign is that of the exact difference, or it is 0 (an edge
  // belongs to the triangle).
  precise float u = c2.x * b2.y - c2.y * b2.x;
  precise float v = a2.x * c2.y - a2.y * c2.x;
  precise float w = b2.x * a2.y - b2.y * a2.x;
  bool is_outside = (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
  // On the line of a triangle seen edge-on, but beyond its corners, they may all round to 0 or to one sign. Where the
  // corners lie tells, without rounding.
  vec2 lo = min(min(a2, b2), c2);
  vec2 hi = max(max(a2, b2), c2);
  bool is_beyond = max(lo.x, lo.y) > 0.0 || min(hi.x, hi.y) < 0.0;
  precise float determinant = u + v + w;
  // Edge-on, or an area whose inverse is no longer a float.
  bool has_area = abs(determinant) >= 1.17549435e-38;
  if (is_outside || is_beyond || !has_area) return NO_CROSSING;

  precise float inverse = 1.0 / determinant;
  precise vec3 weights = vec3(u, v, w) * inverse;
  precise float t = (weights.x * a.z + weights.y * b.z + weights.z * c.z) * ray.shear.z;
  if (!(t > ray.tmin)) return NO_CROSSING;
  return Crossing(t, weights.y, weights.z, PART_SIDE);
}

// P from the corners, not from the ray: the error does not grow with the ray's length.
SurfacePoint triangle_surface(Primitive p, Hit hit) {
  precise vec3 edge1 = corner1(p) - corner0(p);
  precise vec3 edge2 = corner2(p) - corner0(p);
  float size = max(max_abs(edge1), max_abs(edge2));
  precise vec3 position = corner0(p) + (hit.u * edge1 + hit.v * edge2);
  // Scaled first, so that the product of the smallest admissible edges does not underflow.
  float scale = power_of_two_inverse(size);
  precise vec3 scaled1 = edge1 * scale;
  precise vec3 scaled2 = edge2 * scale;
  vec3 normal = normalize3(cross3(scaled1, scaled2));
  precise float lift = 8.0 * UNIT_ROUNDOFF * (max_abs(position) + size);
  return SurfacePoint(position, normal, lift);
}
