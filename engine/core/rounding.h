// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "promin/math.h"

namespace promin {

/// The unit roundoff of fp32, 2^-24.
inline constexpr float kUnitRoundoff = 0x1p-24F;

/// Returns the largest float <= x (round_down) or the smallest float >= x (round_up), so that bounds rounded from
/// double stay conservative.
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

inline bool is_finite(const dmat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(matrix[column][row])) return false;
    }
  }
  return true;
}

inline float max_component(const vec3& v) {
  return std::fmax(v.x, std::fmax(v.y, v.z));
}
inline float max_abs_component(const vec3& v) {
  return max_component(glm::abs(v));
}

}  // namespace promin
