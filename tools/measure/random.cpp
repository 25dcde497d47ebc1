// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/random.h"

#include <cmath>

namespace promin::measure {

dvec3 Random::direction() {
  const double z = uniform(-1.0, 1.0);
  const double angle = uniform(0.0, 6.283185307179586);
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

dvec3 Random::perpendicular(const dvec3& axis) {
  for (;;) {
    const dvec3 cross = glm::cross(axis, direction());
    if (glm::length(cross) > 0.1) return glm::normalize(cross);
  }
}

dvec3 Random::inside(const dvec3& a, const dvec3& b, const dvec3& c) {
  double u = uniform();
  double v = uniform();
  if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
  return a + u * (b - a) + v * (c - a);
}

}  // namespace promin::measure
