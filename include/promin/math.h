// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
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

/// The unit roundoff of fp32, 2^-24.
inline constexpr float kUnitRoundoff = 0x1p-24F;

/// The largest float <= x, and the smallest >= x: bounds rounded from double stay conservative.
inline float round_down(double x) {
  const float rounded = static_cast<float>(x);
  return static_cast<double>(rounded) > x ? std::nextafter(rounded, -std::numeric_limits<float>::infinity()) : rounded;
}
inline float round_up(double x) {
  return -round_down(-x);
}

inline bool is_finite(const vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline float max_component(const vec3& v) {
  return std::fmax(v.x, std::fmax(v.y, v.z));
}
inline float max_abs_component(const vec3& v) {
  return max_component(glm::abs(v));
}

/// An axis-aligned box in fp32. Empty by default: extending it by anything gives that thing.
struct Bounds {
  vec3 lo{std::numeric_limits<float>::infinity()};
  vec3 hi{-std::numeric_limits<float>::infinity()};

  bool is_empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  vec3 center() const { return 0.5F * lo + 0.5F * hi; }
  vec3 extent() const { return hi - lo; }
  /// Half of the surface area, in double: the SAH compares sums of these.
  double half_area() const {
    if (is_empty()) return 0.0;
    const dvec3 e = dvec3(hi) - dvec3(lo);
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
  void extend(const vec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  void extend(const Bounds& b) {
    lo = glm::min(lo, b.lo);
    hi = glm::max(hi, b.hi);
  }
};

}  // namespace promin
