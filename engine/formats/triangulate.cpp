// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/triangulate.h"

#include <cstdint>

namespace promin {
namespace {

/// Returns Newell's normal, which is right for polygons that are concave or not quite flat.
dvec3 normal_of(std::span<const vec3> corners) {
  dvec3 normal(0.0);
  const dvec3 origin(corners[0]);
  for (size_t i = 0; i < corners.size(); ++i) {
    normal += glm::cross(dvec3(corners[i]) - origin, dvec3(corners[(i + 1) % corners.size()]) - origin);
  }
  return normal;
}

/// Projects the polygon along the axis that is nearest to the normal. The result is counter-clockwise.
std::vector<dvec2> flatten(std::span<const vec3> corners) {
  const dvec3 normal = normal_of(corners);
  const dvec3 size = glm::abs(normal);
  const int dropped = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
  int u = (dropped + 1) % 3;
  int v = (dropped + 2) % 3;
  if (normal[dropped] < 0.0) std::swap(u, v);
  std::vector<dvec2> flat;
  for (const vec3& corner : corners) flat.emplace_back(corner[u], corner[v]);
  return flat;
}

/// Returns twice the area of the triangle a, b, c; positive if it is counter-clockwise.
double turn(const dvec2& a, const dvec2& b, const dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Divides a polygon into triangles. It has a ring of the corners that are not yet cut off.
class EarClipper {
 public:
  explicit EarClipper(std::vector<dvec2> points) : points_(std::move(points)) {
    for (uint32_t i = 0; i < points_.size(); ++i) ring_.push_back(i);
  }

  bool is_convex() const {
    for (size_t i = 0; i < ring_.size(); ++i) {
      if (turn_at(i) < 0.0) return false;
    }
    return true;
  }

  std::vector<uvec3> clip() {
    std::vector<uvec3> triangles;
    size_t i = 0;
    while (ring_.size() > 3) {
      size_t tries = 0;
      while (!is_ear(i) && tries < ring_.size()) {
        i = (i + 1) % ring_.size();
        ++tries;
      }
      // A polygon that crosses itself may have no ear. Then any corner is cut off.
      triangles.emplace_back(at(i, -1), at(i, 0), at(i, 1));
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(i));
      i %= ring_.size();
    }
    triangles.emplace_back(ring_[0], ring_[1], ring_[2]);
    return triangles;
  }

 private:
  uint32_t at(size_t i, int step) const {
    return ring_[(i + ring_.size() + static_cast<size_t>(step + 1) - 1) % ring_.size()];
  }
  double turn_at(size_t i) const { return turn(points_[at(i, -1)], points_[at(i, 0)], points_[at(i, 1)]); }

  /// Returns whether corner i is an ear: the polygon turns left there, and the corner's triangle contains no other
  /// corner.
  bool is_ear(size_t i) const {
    if (turn_at(i) <= 0.0) return false;
    const dvec2 a = points_[at(i, -1)];
    const dvec2 b = points_[at(i, 0)];
    const dvec2 c = points_[at(i, 1)];
    for (const uint32_t other : ring_) {
      const dvec2 p = points_[other];
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
  }

  std::vector<dvec2> points_;
  std::vector<uint32_t> ring_;
};

}  // namespace

std::vector<uvec3> triangulate_polygon(std::span<const vec3> corners) {
  if (corners.size() > 3) {
    EarClipper clipper(flatten(corners));
    if (!clipper.is_convex()) return clipper.clip();
  }
  std::vector<uvec3> fan;
  for (uint32_t i = 1; i + 1 < corners.size(); ++i) fan.emplace_back(0, i, i + 1);
  return fan;
}

}  // namespace promin
