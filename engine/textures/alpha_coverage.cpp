// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/alpha_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace promin {
namespace {

constexpr uint32_t kMostAlpha = 255;
constexpr uint32_t kAlphaShift = 24;
constexpr uint32_t kColorMask = 0x00FFFFFF;

/// Returns the smallest byte that is at least the cutoff when the device compares them; 256 if there is none.
uint32_t least_byte(float cutoff) {
  uint32_t byte = 0;
  while (byte <= kMostAlpha && static_cast<float>(byte) * (1.0F / 255.0F) < cutoff) ++byte;
  return byte;
}

/// Returns for each byte the number of texels whose alpha is at least this byte.
std::array<uint64_t, kMostAlpha + 1> count_from(std::span<const uint32_t> texels) {
  std::array<uint64_t, kMostAlpha + 1> counts{};
  for (const uint32_t texel : texels) ++counts[texel >> kAlphaShift];
  for (uint32_t alpha = kMostAlpha; alpha > 0; --alpha) counts[alpha - 1] += counts[alpha];
  return counts;
}

/// Returns the smallest alpha whose texels must be above the cutoff after scaling. If several alphas give the same
/// coverage, it is the one nearest to the cutoff.
uint32_t find_threshold(std::span<const uint32_t> texels, uint32_t cutoff, double coverage) {
  const auto counts = count_from(texels);
  const double wanted = coverage * static_cast<double>(texels.size());
  uint32_t best = cutoff;
  const auto miss = [&](uint32_t alpha) { return std::abs(static_cast<double>(counts[alpha]) - wanted); };
  for (uint32_t distance = 1; distance <= kMostAlpha; ++distance) {
    if (distance < cutoff && miss(cutoff - distance) < miss(best)) best = cutoff - distance;
    if (cutoff + distance <= kMostAlpha && miss(cutoff + distance) < miss(best)) best = cutoff + distance;
  }
  return best;
}

}  // namespace

double alpha_coverage(std::span<const uint32_t> texels, float cutoff) {
  const uint32_t least = least_byte(cutoff);
  if (texels.empty() || least > kMostAlpha) return 0.0;
  return static_cast<double>(count_from(texels)[least]) / static_cast<double>(texels.size());
}

void scale_alpha_to_coverage(std::span<uint32_t> texels, float cutoff, double coverage) {
  const uint32_t least = least_byte(cutoff);
  if (texels.empty() || least == 0 || least > kMostAlpha || coverage <= 0.0 || coverage >= 1.0) return;
  const uint32_t threshold = find_threshold(texels, least, coverage);
  for (uint32_t& texel : texels) {
    const uint32_t alpha = texel >> kAlphaShift;
    const uint32_t scaled = (alpha * least + threshold / 2) / threshold;
    // The result is clamped, so that rounding does not move an alpha across the cutoff.
    const uint32_t result = alpha >= threshold ? std::min(scaled, kMostAlpha) : std::min(scaled, least - 1);
    texel = (texel & kColorMask) | result << kAlphaShift;
  }
}

}  // namespace promin
