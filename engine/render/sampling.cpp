// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace promin {
namespace {

/// Squared distance, on the torus and in units of 1 / count, between the two nearest of the points.
uint64_t smallest_distance2(uint32_t count, uint32_t generator, uint64_t give_up_below) {
  const auto wrap = [count](int64_t d) {
    const auto size = static_cast<int64_t>(count);
    d = ((d % size) + size) % size;
    return std::min(d, size - d);
  };
  const auto row = [&](uint32_t i) {
    return static_cast<int64_t>((static_cast<uint64_t>(generator) * (i + 1)) % (count + 1)) - 1;
  };
  uint64_t smallest = std::numeric_limits<uint64_t>::max();
  for (uint32_t i = 0; i < count; ++i) {
    for (uint32_t j = i + 1; j < count; ++j) {
      const int64_t dx = wrap(static_cast<int64_t>(j) - i);
      if (static_cast<uint64_t>(dx * dx) >= smallest) continue;
      const int64_t dy = wrap(row(j) - row(i));
      smallest = std::min(smallest, static_cast<uint64_t>(dx * dx + dy * dy));
      if (smallest <= give_up_below) return smallest;
    }
  }
  return smallest;
}

}  // namespace

uint32_t lattice_generator(uint32_t count) {
  // The search is cubic; beyond, the golden ratio's nearest coprime is good enough (Niederreiter 1992, ch. 5).
  constexpr uint32_t kLargestSearched = 128;
  const uint32_t modulus = count + 1;
  if (count > kLargestSearched) {
    const auto golden = static_cast<uint32_t>(std::lround(modulus / std::numbers::phi));
    for (uint32_t offset = 0;; ++offset) {
      if (std::gcd(golden + offset, modulus) == 1) return golden + offset;
      if (std::gcd(golden - offset, modulus) == 1) return golden - offset;
    }
  }
  uint32_t best = 1;
  uint64_t best_distance2 = 0;
  for (uint32_t generator = 1; generator < modulus; ++generator) {
    if (std::gcd(generator, modulus) != 1) continue;
    const uint64_t distance2 = smallest_distance2(count, generator, best_distance2);
    if (distance2 > best_distance2) {
      best = generator;
      best_distance2 = distance2;
    }
  }
  return best;
}

}  // namespace promin
