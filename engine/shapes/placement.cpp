// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "shapes/placement.h"

#include <algorithm>

namespace promin {
namespace {

constexpr double kTolerance = 1e-5;

bool is_close(double a, double b) {
  return std::abs(a - b) <= kTolerance * std::max(a, b);
}

bool is_right_angle(const dvec3& a, const dvec3& b) {
  return std::abs(glm::dot(a, b)) <= kTolerance * glm::length(a) * glm::length(b);
}

/// Returns the sum of columns times components. Components that are 0 are left out.
dvec3 combine(const dvec3 (&columns)[3], const dvec3& v) {
  dvec3 sum(0.0);
  bool is_first = true;
  for (int i = 0; i < 3; ++i) {
    if (v[i] == 0.0) continue;
    const dvec3 term = v[i] * columns[i];
    sum = is_first ? term : sum + term;
    is_first = false;
  }
  return sum;
}

/// Two unit vectors that are perpendicular to an axis and to each other. For +Y they are +X and +Z.
struct Across {
  dvec3 first;
  dvec3 second;
};

Across across(const dvec3& axis) {
  if (axis.x == 0.0 && axis.z == 0.0) return {dvec3(1, 0, 0), dvec3(0, 0, 1)};
  const dvec3 unit = glm::normalize(axis);
  const dvec3 other = std::abs(unit.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 0, 1);
  const dvec3 first = glm::normalize(other - glm::dot(other, unit) * unit);
  return {first, glm::cross(unit, first)};
}

}  // namespace

Placement::Placement(const dmat4& m)
    : origin_(m[3]), columns_{dvec3(m[0]), dvec3(m[1]), dvec3(m[2])}, is_identity_(m == dmat4(1.0)) {}

bool Placement::keeps_spheres() const {
  return is_identity_ ||
         (keeps_cylinders(dvec3(0, 1, 0)) && is_close(glm::length(columns_[1]), glm::length(columns_[0])));
}

bool Placement::keeps_cylinders(const dvec3& axis) const {
  const Across both = across(axis);
  const dvec3 x = direction(both.first);
  const dvec3 y = direction(axis);
  const dvec3 z = direction(both.second);
  return is_close(glm::length(z), glm::length(x)) && is_right_angle(x, y) && is_right_angle(y, z) &&
         is_right_angle(z, x);
}

bool Placement::keeps_boxes() const {
  return is_right_angle(columns_[0], columns_[1]) && is_right_angle(columns_[1], columns_[2]) &&
         is_right_angle(columns_[2], columns_[0]);
}

dvec3 Placement::direction(const dvec3& v) const {
  return combine(columns_, v);
}

dvec3 Placement::normal(const dvec3& n) const {
  const double sign = is_mirroring() ? -1.0 : 1.0;
  const dvec3 cofactors[3] = {sign * glm::cross(columns_[1], columns_[2]), sign * glm::cross(columns_[2], columns_[0]),
                              sign * glm::cross(columns_[0], columns_[1])};
  return combine(cofactors, n);
}

double Placement::scale_along(const dvec3& v) const {
  return glm::length(direction(v)) / glm::length(v);
}

double Placement::scale_across(const dvec3& axis) const {
  return glm::length(direction(across(axis).first));
}

bool Placement::is_mirroring() const {
  return glm::determinant(dmat3(columns_[0], columns_[1], columns_[2])) < 0.0;
}

}  // namespace promin
