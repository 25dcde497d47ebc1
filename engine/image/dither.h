// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace promin {

// As shaders/dither.glsl has it.

/// An integer hash (Wellons, "Prospecting for Hash Functions", lowbias32).
inline uint32_t hash_of(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7FEB352DU;
  x ^= x >> 15;
  x *= 0x846CA68BU;
  return x ^ x >> 16;
}

/// A code of 0...255 with noise before it is rounded, so that gradients show no bands: of a triangular distribution one
/// step wide to either side, as it takes to make the error's mean and variance the same for all codes (Lipshitz et al.,
/// "Quantization and Dither: A Theoretical Survey", 1992); within a step of 0 and 255, beyond which nothing is, of a
/// uniform one half as wide, which keeps the mean. It hangs on the place in the whole picture alone.
inline float dithered(float code, uint32_t x, uint32_t y, uint32_t channel) {
  const uint32_t first = hash_of(x + hash_of(y + hash_of(channel)));
  const uint32_t second = hash_of(first);
  const bool is_at_end = code < 1.0F || code > 254.0F;
  const uint32_t sum = (first >> 9) + (is_at_end ? 1U << 22 : second >> 9);
  return std::clamp(code + (static_cast<float>(sum) * 0x1p-23F - 1.0F), 0.0F, 255.0F);
}

}  // namespace promin
