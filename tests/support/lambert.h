// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <vector>

#include "promin/math.h"

namespace promin::test {

/// Returns Lambert's formula for the irradiance that a polygon of radiance 1 causes at a point of a plane y = constant.
/// The polygon is on one side of the plane.
inline double irradiance_of(std::vector<dvec3> corners, const dvec3& at) {
  double sum = 0.0;
  for (dvec3& corner : corners) corner = glm::normalize(corner - at);
  for (size_t i = 0; i < corners.size(); ++i) {
    const dvec3& a = corners[i];
    const dvec3& b = corners[(i + 1) % corners.size()];
    sum += std::acos(glm::dot(a, b)) * glm::normalize(glm::cross(b, a)).y;
  }
  return std::abs(0.5 * sum);
}

}  // namespace promin::test
