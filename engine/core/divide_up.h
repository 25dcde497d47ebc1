// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace promin {

/// Returns a / b, rounded up. The sum a + b must not overflow.
template <typename T>
constexpr T divide_up(T a, T b) {
  return (a + b - 1) / b;
}

/// Returns the smallest multiple of `step` that is at least `value`. The sum of both must not overflow.
template <typename T>
constexpr T next_multiple(T value, T step) {
  return divide_up(value, step) * step;
}

}  // namespace promin
