// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/hash.h"

namespace promin {

/// Returns a code of 0...255 with noise, to be rounded, so that gradients show no bands. The noise has a triangular
/// distribution of one step to either side, which makes the error's mean and variance the same for all codes (Lipshitz
/// et al., "Quantization and Dither: A Theoretical Survey", 1992). Codes cannot exceed 0 and 255, so within one step of
/// these the noise has a uniform distribution of half the width, which keeps the mean. The noise depends only on the
/// position in the whole picture. shaders/window/dither.glsl computes the same.
inline float dithered(float code, uint32_t x, uint32_t y, uint32_t channel) {
  const uint32_t first = mix_bits(x + mix_bits(y + mix_bits(channel)));
  const uint32_t second = mix_bits(first);
  const bool is_at_end = code < 1.0F || code > 254.0F;
  const uint32_t sum = (first >> 9) + (is_at_end ? 1U << 22 : second >> 9);
  return std::clamp(code + (static_cast<float>(sum) * 0x1p-23F - 1.0F), 0.0F, 255.0F);
}

}  // namespace promin
