// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

namespace promin {

/// Returns the absolute difference of two values of a channel. It is infinite if only one value is finite, or if
/// neither is finite and they differ.
inline double difference_of(double a, double b) {
  if (std::isfinite(a) && std::isfinite(b)) return std::abs(a - b);
  const bool is_same = a == b || (std::isnan(a) && std::isnan(b));
  return is_same ? 0.0 : std::numeric_limits<double>::infinity();
}

}  // namespace promin
