// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace promin {

/// Returns number i of van der Corput's sequence to the base 2, in [0, 1).
inline double radical_inverse(uint32_t i) {
  double inverse = 0.0;
  for (double digit = 0.5; i != 0; i >>= 1, digit *= 0.5) inverse += (i & 1) != 0 ? digit : 0.0;
  return inverse;
}

}  // namespace promin
