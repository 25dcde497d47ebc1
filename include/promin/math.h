// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace promin {

using glm::dmat3;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

// Vectors and matrices are GLM's, of floats, doubles (d) and 32-bit unsigned integers (u). Matrices are stored by
// columns and multiply columns from the left.

/// An axis-aligned box in fp32. Empty by default: extending it by anything gives that thing.
struct Bounds {
  /// The corner of least coordinates.
  vec3 lo{std::numeric_limits<float>::infinity()};
  /// The corner of greatest coordinates.
  vec3 hi{-std::numeric_limits<float>::infinity()};

  /// Whether no point is in it; a box of one point is not empty.
  bool is_empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  /// The point in the middle, of a box that is not empty.
  vec3 center() const { return 0.5F * lo + 0.5F * hi; }
  /// Lengths of the edges, of a box that is not empty.
  vec3 extent() const { return hi - lo; }
  /// Half of the surface area, in double so that sums of many keep their order; 0 of an empty box.
  double half_area() const {
    if (is_empty()) return 0.0;
    const dvec3 e = dvec3(hi) - dvec3(lo);
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
  /// Takes a point in.
  void extend(const vec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  /// Takes another box in.
  void extend(const Bounds& b) {
    lo = glm::min(lo, b.lo);
    hi = glm::max(hi, b.hi);
  }
};

}  // namespace promin
