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

// Vectors and matrices are GLM's types, of floats, doubles (d) and 32-bit unsigned integers (u). Matrices are stored by
// columns and multiply column vectors from the left.

/// An axis-aligned box in fp32, empty by default. If an empty box is extended by a point or a box, the result is the
/// bounds of that point or box.
struct Bounds {
  /// The corner with the smallest coordinates.
  vec3 lo{std::numeric_limits<float>::infinity()};
  /// The corner with the largest coordinates.
  vec3 hi{-std::numeric_limits<float>::infinity()};

  /// Returns whether the box contains no point. A box of one point is not empty.
  bool is_empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  /// Returns the centre of a box that is not empty.
  vec3 center() const { return 0.5F * lo + 0.5F * hi; }
  /// Returns the lengths of the edges of a box that is not empty.
  vec3 extent() const { return hi - lo; }
  /// Returns half the surface area; 0 for an empty box. The result is a double because fp32 would overflow or lose
  /// digits in sums over many boxes.
  double half_area() const {
    if (is_empty()) return 0.0;
    const dvec3 e = dvec3(hi) - dvec3(lo);
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
  /// Extends the box to contain a point.
  void extend(const vec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  /// Extends the box to contain another box.
  void extend(const Bounds& b) {
    lo = glm::min(lo, b.lo);
    hi = glm::max(hi, b.hi);
  }
};

}  // namespace promin
