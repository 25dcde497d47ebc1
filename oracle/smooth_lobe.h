// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "oracle/lobe.h"
#include "oracle/samples.h"

namespace promin::oracle {

/// The lobe of a metallic-roughness material from which directions to lights may be chosen.
struct SmoothLobe {
  Vector normal{0};
  Vector to_eye{0};
  Real alpha = 1;

  Real cosine_to_eye() const { return std::max(glm::dot(to_eye, normal), 0x1p-10L); }

  /// Returns the normal of the facet that the eye sees for a point of the unit square.
  Vector facet(const std::array<Real, 2>& u) const {
    const Vector helper = std::abs(normal.x) < 0.57L ? Vector(1, 0, 0) : Vector(0, 1, 0);
    const Vector across = glm::normalize(glm::cross(normal, helper));
    const Vector along = glm::cross(normal, across);
    const Vector wide =
        glm::normalize(Vector(alpha * glm::dot(to_eye, across), alpha * glm::dot(to_eye, along), cosine_to_eye()));
    // A point of the cap of the unit sphere that the stretched eye's direction sees, by areas.
    const auto [x, y] = place_on_disc(u);
    const Real share = x * x + y * y;
    const Real azimuth = std::atan2(y, x);
    const Real height = 1 - share * (1 + wide.z);
    const Real aside = std::sqrt(std::max(1 - height * height, Real(0)));
    const Vector sum = Vector(aside * std::cos(azimuth), aside * std::sin(azimuth), height) + wide;
    const Vector local = glm::normalize(Vector(alpha * sum.x, alpha * sum.y, std::max(sum.z, Real(0))));
    return local.x * across + local.y * along + local.z * normal;
  }
  /// Returns the direction that this facet reflects to the eye.
  Vector place(const std::array<Real, 2>& u) const { return glm::reflect(-to_eye, facet(u)); }
  /// Returns the density of place() per steradian: D G1 / (4 N.V).
  Real density(const Vector& direction) const {
    const Vector sum = to_eye + direction;
    if (glm::length(sum) < 0x1p-12L) return 0;
    const Real v = cosine_to_eye();
    const Real theta = 2 * std::asin(std::min(glm::distance(glm::normalize(sum), normal) / 2, Real(1)));
    const Real tangent2 = 1 / (v * v) - 1;
    const Real masking = 2 / (1 + std::sqrt(1 + alpha * alpha * tangent2));
    return microfacet_density(theta, alpha) * masking / (4 * v);
  }
};

}  // namespace promin::oracle
