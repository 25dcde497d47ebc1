// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "promin/math.h"

namespace promin::measure {

/// Random numbers that are the same on every platform, unlike those of the standard distributions. They are the upper
/// 53 bits of std::mt19937_64, whose sequence the standard fixes.
class Random {
 public:
  explicit Random(uint64_t seed) : generator_(seed) {}
  /// Returns a number in [0, 1).
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  /// Returns a unit vector; all directions are equally likely.
  dvec3 direction();
  /// Returns a random unit vector that is perpendicular to the given unit vector.
  dvec3 perpendicular(const dvec3& axis);
  /// Returns a point in the triangle; all points are equally likely.
  dvec3 inside(const dvec3& a, const dvec3& b, const dvec3& c);

 private:
  std::mt19937_64 generator_;
};

}  // namespace promin::measure
