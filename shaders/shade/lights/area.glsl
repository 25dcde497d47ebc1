// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Rectangles and disks that shine from one side (docs/model.md, "Lights with a size").

// The smallest solid angle from which directions to a rectangle are chosen by solid angle. In fp32, that of a smaller
// rectangle has too large an error. Points of such a rectangle are chosen by area.
const float LEAST_RECT_ANGLE = 0.0625;

// Returns the arc tangent of any number, accurate to a few u (Cephes, atanf).
precise float arc_tangent(float x) {
  float a = abs(x);
  bool is_large = a > 2.41421356;
  bool is_middle = a > 0.414213562;
  precise float reduced = is_large ? -1.0 / a : (is_middle ? (a - 1.0) / (a + 1.0) : a);
  float offset = is_large ? 1.57079633 : (is_middle ? 0.785398163 : 0.0);
  precise float z = reduced * reduced;
  precise float tail =
      (((0.0805374450 * z - 0.138776856) * z + 0.199777106) * z - 0.333329492) * z * reduced + reduced;
  precise float result = offset + tail;
  return x < 0.0 ? -result : result;
}

// Returns the solid angle of the rectangle from (0, 0) to (x, y) at the distance z.
precise float corner_angle(float x, float y, float z) {
  return arc_tangent(x * y / (z * sqrt(x * x + (y * y + z * z))));
}

// Returns the cosine and the sine of an angle within -pi...pi.
vec2 cosine_and_sine(float angle) {
  precise float quarter = 0.25 * angle;
  float s = short_sine(quarter);
  float c = short_cosine(quarter);
  precise float s2 = 2.0 * s * c;
  precise float c2 = 1.0 - 2.0 * s * s;
  precise vec2 result = vec2(1.0 - 2.0 * s2 * s2, 2.0 * s2 * c2);
  return result;
}

// Returns a point of a rectangle at the distance z, from x = lo.x to hi.x and y = lo.y to hi.y, with uniform density
// over its solid angle (Urena, Fajardo and King, "An Area-Preserving Parametrization for Spherical Rectangles", 2013).
// The solid angle up to x is the difference of two angles; its equation for x has a closed form.
vec2 point_by_angle(vec2 lo, vec2 hi, float z, float solid_angle, vec2 u) {
  precise float begin = corner_angle(lo.x, hi.y, z) - corner_angle(lo.x, lo.y, z);
  precise float angle = u.x * solid_angle + begin;
  vec2 cs = cosine_and_sine(angle);
  precise float z2 = z * z;
  precise float b0 = lo.y / sqrt(z2 + lo.y * lo.y);
  precise float b1 = hi.y / sqrt(z2 + hi.y * hi.y);
  // With f = (b1 - b0 cos) / sin, x = z / sqrt(f^2 + b0^2 - 1), with the sign of the angle.
  precise float numerator = b1 - b0 * cs.x;
  precise float s2 = cs.y * cs.y;
  precise float below = max(numerator * numerator - (1.0 - b0) * (1.0 + b0) * s2, 0.0);
  precise float ratio = cs.y / sqrt(max(below, SMALLEST_NORMAL));
  precise float x = clamp(z * ratio, lo.x, hi.x);
  precise float d2 = x * x + z2;
  precise float h0 = lo.y / sqrt(d2 + lo.y * lo.y);
  precise float h1 = hi.y / sqrt(d2 + hi.y * hi.y);
  precise float h = h0 + u.y * (h1 - h0);
  precise float y = h * sqrt(d2 / max((1.0 - h) * (1.0 + h), SMALLEST_NORMAL));
  return vec2(x, clamp(y, lo.y, hi.y));
}

// Returns a point of the light as seen from `position`. strength is the radiance of a light of power 1 divided by the
// density.
LightSample sample_area(LightRecord light, vec3 position, bool is_disk) {
  precise vec3 to_center = light.position.xyz - position;
  vec3 right = vec3(light.diffuse.w, light.specular.w, uintBitsToFloat(light.kind.z));
  vec3 up = cross3(light.direction.xyz, right);
  vec2 half_size = vec2(light.direction.w, light.position.w);
  // All lengths are scaled by a power of two, so that no square overflows or vanishes.
  float unit = power_of_two_inverse(max(max_abs(to_center), max(half_size.x, half_size.y)));
  precise vec3 to = to_center * unit;
  precise vec2 h = half_size * unit;
  // The distance is positive for points in front of the light.
  precise float z = -dot3(to, light.direction.xyz);
  precise vec2 middle = vec2(dot3(to, right), dot3(to, up));
  precise vec2 lo = middle - h;
  precise vec2 hi = middle + h;
  bool is_seen = z > 0.0;
  z = is_seen ? z : 1.0;
  precise float solid_angle = (corner_angle(hi.x, hi.y, z) - corner_angle(lo.x, hi.y, z)) -
                              (corner_angle(hi.x, lo.y, z) - corner_angle(lo.x, lo.y, z));
  vec2 u = sample_u;
  vec2 at;
  precise float strength;
  if (solid_angle >= LEAST_RECT_ANGLE) {
    at = point_by_angle(lo, hi, z, solid_angle, u);
    strength = solid_angle;
    // A disk is a part of its square. Directions to the corners do not see it.
    precise vec2 off = (at - middle) / h;
    precise float radius2 = off.x * off.x + off.y * off.y;
    if (is_disk && radius2 > 1.0) strength = 0.0;
  } else {
    precise vec2 on_square = 2.0 * u - 1.0;
    vec2 off = is_disk ? point_on_disc(u).xy : on_square;
    precise vec2 shifted = middle + off * h;
    at = shifted;
    precise float d2 = at.x * at.x + (at.y * at.y + z * z);
    precise float area = (is_disk ? 3.14159265 : 4.0) * (h.x * h.y);
    strength = area * z / (d2 * sqrt(d2));
  }
  precise vec3 to_point = (at.x * right + (at.y * up - z * light.direction.xyz)) / unit;
  return LightSample(to_point, 1.0, is_seen ? strength : 0.0);
}

LightSample sample_rect(LightRecord light, vec3 position) { return sample_area(light, position, false); }
LightSample sample_disk(LightRecord light, vec3 position) { return sample_area(light, position, true); }
