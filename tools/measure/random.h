// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "promin/math.h"

namespace promin::measure {

/// The same numbers on every platform, unlike the standard distributions: of std::mt19937_64, whose sequence the
/// standard fixes, the upper 53 bits.
class Random {
 public:
  explicit Random(uint64_t seed) : generator_(seed) {}
  /// [0, 1).
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  /// A unit vector, all directions alike.
  dvec3 direction();
  /// A unit vector perpendicular to a unit vector.
  dvec3 perpendicular(const dvec3& axis);
  /// In the triangle, all places alike.
  dvec3 inside(const dvec3& a, const dvec3& b, const dvec3& c);

 private:
  std::mt19937_64 generator_;
};

}  // namespace promin::measure
