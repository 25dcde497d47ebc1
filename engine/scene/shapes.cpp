// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/shapes.h"

namespace promin {
namespace {

/// The fp32 axis is unit only to rounding, so a shape's true extent may exceed the computed one by a few roundings:
/// 2 ulp of the largest magnitude that takes part.
constexpr double kMargin = 4.0 * static_cast<double>(kUnitRoundoff);

struct Disk {
  dvec3 center;
  double radius;
};

Bounds round_outward(const dvec3& lo, const dvec3& hi, const dvec3& magnitude) {
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    bounds.lo[i] = round_down(lo[i] - kMargin * magnitude[i]);
    bounds.hi[i] = round_up(hi[i] + kMargin * magnitude[i]);
  }
  return bounds;
}

/// The solid is the convex hull of its two disks, so their bounds are its bounds. A disk with unit normal a reaches
/// radius * sqrt(1 - a_i^2) along axis i; as the length of the other two components it does not cancel near 1.
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

}  // namespace

Bounds bounds_of(const Sphere& sphere) {
  const dvec3 center(sphere.center);
  const double radius = sphere.radius;
  return round_outward(center - radius, center + radius, glm::abs(center) + radius);
}

Bounds bounds_of(const Cylinder& cylinder) {
  return bounds_of_disks(cylinder.center, cylinder.axis, cylinder.half_height, cylinder.radius, cylinder.radius);
}

Bounds bounds_of(const Cone& cone) {
  return bounds_of_disks(cone.center, cone.axis, cone.half_height, cone.radius_bottom, cone.radius_top);
}

Bounds bounds_of_triangle(const Mesh& mesh, uint32_t triangle) {
  Bounds bounds;
  const uvec3 corners = mesh.triangles[triangle];
  for (int i = 0; i < 3; ++i) bounds.extend(mesh.positions[corners[i]]);
  return bounds;
}

bool is_degenerate(const Mesh& mesh, uint32_t triangle) {
  const uvec3 corners = mesh.triangles[triangle];
  const dvec3 a(mesh.positions[corners.x]);
  // Differences of nearby fp32 numbers and their products are exact in double, so collinear means exactly zero.
  return glm::cross(dvec3(mesh.positions[corners.y]) - a, dvec3(mesh.positions[corners.z]) - a) == dvec3(0.0);
}

}  // namespace promin
