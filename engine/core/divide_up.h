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

}  // namespace promin
