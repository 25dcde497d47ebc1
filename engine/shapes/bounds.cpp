// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "core/rounding.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

constexpr double kMargin = 4.0 * static_cast<double>(kUnitRoundoff);

struct Disk {
  dvec3 center;
  double radius;
};

}  // namespace

Bounds round_outward(const dvec3& lo, const dvec3& hi, const dvec3& magnitude) {
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    bounds.lo[i] = round_down(lo[i] - kMargin * magnitude[i]);
    bounds.hi[i] = round_up(hi[i] + kMargin * magnitude[i]);
  }
  return bounds;
}

// Returns the bounds of disks. A disk with the unit normal a extends radius * sqrt(1 - a_i^2) along axis i. The code
// computes this root as the length of the other two components, because the difference would lose digits near 1.
Bounds bounds_of_disks(const vec3& center, const vec3& axis, double half_height, double radius_bottom,
                       double radius_top) {
  const dvec3 unit = glm::normalize(dvec3(axis));
  const dvec3 reach(std::hypot(unit.y, unit.z), std::hypot(unit.z, unit.x), std::hypot(unit.x, unit.y));
  const dvec3 step = half_height * unit;
  dvec3 lo(std::numeric_limits<double>::infinity());
  dvec3 hi = -lo;
  for (const Disk& disk : {Disk{dvec3(center) - step, radius_bottom}, Disk{dvec3(center) + step, radius_top}}) {
    lo = glm::min(lo, disk.center - disk.radius * reach);
    hi = glm::max(hi, disk.center + disk.radius * reach);
  }
  const double size = half_height + std::fmax(radius_bottom, radius_top);
  return round_outward(lo, hi, glm::abs(dvec3(center)) + size);
}

dvec3 farthest_of_disks(const vec3& center, const vec3& axis, double half_height, double radius_bottom,
                        double radius_top, const dvec3& direction) {
  const dvec3 unit = glm::normalize(dvec3(axis));
  const dvec3 across = direction - glm::dot(direction, unit) * unit;
  const double length = glm::length(across);
  const dvec3 outward = length > 0.0 ? across / length : dvec3(0.0);
  const dvec3 bottom = dvec3(center) - half_height * unit + radius_bottom * outward;
  const dvec3 top = dvec3(center) + half_height * unit + radius_top * outward;
  return glm::dot(top - bottom, direction) > 0.0 ? top : bottom;
}

}  // namespace promin
