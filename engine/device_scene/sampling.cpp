// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace promin {
namespace {

/// Squared length of the shortest vector between points of the lattice (i, g i) mod `modulus`.
uint64_t shortest_vector2(uint32_t generator, uint32_t modulus) {
  const auto wrap = [modulus](uint64_t d) { return std::min(d % modulus, modulus - d % modulus); };
  uint64_t shortest2 = std::numeric_limits<uint64_t>::max();
  for (uint64_t i = 1; i < modulus; ++i) {
    const uint64_t dx = wrap(i);
    const uint64_t dy = wrap(i * generator);
    shortest2 = std::min(shortest2, dx * dx + dy * dy);
  }
  return shortest2;
}

}  // namespace

uint32_t lattice_generator(uint32_t count) {
  // The search is quadratic. For more points the golden ratio's nearest coprime is good enough (Niederreiter 1992, ch.
  // 5).
  constexpr uint32_t kLargestSearched = 1024;
  const uint32_t modulus = count + 1;
  if (count > kLargestSearched) {
    const auto golden = static_cast<uint32_t>(std::lround(modulus / std::numbers::phi));
    for (uint32_t offset = 0;; ++offset) {
      if (std::gcd(golden + offset, modulus) == 1) return golden + offset;
      if (std::gcd(golden - offset, modulus) == 1) return golden - offset;
    }
  }
  uint32_t best = 1;
  uint64_t best_vector2 = 0;
  for (uint32_t generator = 1; generator < modulus; ++generator) {
    if (std::gcd(generator, modulus) != 1) continue;
    const uint64_t vector2 = shortest_vector2(generator, modulus);
    if (vector2 > best_vector2) {
      best = generator;
      best_vector2 = vector2;
    }
  }
  return best;
}

}  // namespace promin
