// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/clip_triangle.h"

#include <algorithm>

#include "core/rounding.h"

namespace promin {
namespace {

/// A convex polygon with space for three corners and one more for each plane.
struct Polygon {
  std::array<dvec3, 9> points;
  size_t count = 0;

  void add(const dvec3& point) { points[count++] = point; }
};

/// Returns the part of the polygon where side * (p[axis] - plane) <= 0 (Sutherland & Hodgman 1974).
Polygon clip(const Polygon& polygon, int axis, double plane, double side) {
  Polygon inside;
  for (size_t i = 0; i < polygon.count; ++i) {
    const dvec3& a = polygon.points[i];
    const dvec3& b = polygon.points[i + 1 < polygon.count ? i + 1 : 0];
    const double beyond_a = side * (a[axis] - plane);
    const double beyond_b = side * (b[axis] - plane);
    if (beyond_a <= 0.0) inside.add(a);
    if ((beyond_a < 0.0 && beyond_b > 0.0) || (beyond_a > 0.0 && beyond_b < 0.0)) {
      inside.add(a + (b - a) * (beyond_a / (beyond_a - beyond_b)));
    }
  }
  return inside;
}

}  // namespace

Bounds clip_triangle(const std::array<vec3, 3>& corners, const Bounds& window) {
  Bounds whole;
  Polygon polygon;
  for (const vec3& corner : corners) {
    whole.extend(corner);
    polygon.add(dvec3(corner));
  }
  // Clipping at six planes moves corners by less than 2^-46 of the size. The planes are moved outwards by more than
  // this, so that no part is lost if a side of the polygon lies almost in a plane.
  const auto size = static_cast<double>(std::max(max_abs_component(whole.lo), max_abs_component(whole.hi)));
  const double margin = 0x1p-44 * size;
  for (int axis = 0; axis < 3; ++axis) {
    if (whole.lo[axis] < window.lo[axis]) {
      polygon = clip(polygon, axis, static_cast<double>(window.lo[axis]) - margin, -1.0);
    }
    if (whole.hi[axis] > window.hi[axis]) {
      polygon = clip(polygon, axis, static_cast<double>(window.hi[axis]) + margin, 1.0);
    }
  }
  if (polygon.count == 0) return {};
  dvec3 lo(std::numeric_limits<double>::infinity());
  dvec3 hi(-lo);
  for (size_t i = 0; i < polygon.count; ++i) {
    lo = glm::min(lo, polygon.points[i]);
    hi = glm::max(hi, polygon.points[i]);
  }
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lo[axis] = std::max({round_down(lo[axis] - margin), whole.lo[axis], window.lo[axis]});
    bounds.hi[axis] = std::min({round_up(hi[axis] + margin), whole.hi[axis], window.hi[axis]});
  }
  return bounds.is_empty() ? Bounds() : bounds;
}

}  // namespace promin
