// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace promin {
namespace {

/// Returns the squared length of the shortest vector between points (i, g i) mod `modulus` of the lattice.
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

/// Returns the fraction of a filter's weight that lies before x, for a filter of width 2 with x in -1...1.
double share_before(PixelFilter filter, double x) {
  switch (filter) {
    case PixelFilter::kBox:
      break;
    case PixelFilter::kTent:
      return x < 0.0 ? 0.5 * (1.0 + x) * (1.0 + x) : 1.0 - 0.5 * (1.0 - x) * (1.0 - x);
    case PixelFilter::kGauss: {
      const double end = 3.0 / std::numbers::sqrt2;
      return 0.5 + 0.5 * std::erf(end * x) / std::erf(end);
    }
    case PixelFilter::kBlackmanHarris: {
      // The integral of the four cosine terms of the window (Harris 1978).
      const double t = 0.5 * (1.0 + x);
      constexpr std::array kTerms = {-0.48829 / 2.0, 0.14128 / 4.0, -0.01168 / 6.0};
      double sum = 0.35875 * t;
      for (size_t i = 0; i < kTerms.size(); ++i) {
        sum += kTerms[i] / std::numbers::pi * std::sin(2.0 * std::numbers::pi * static_cast<double>(i + 1) * t);
      }
      return sum / 0.35875;
    }
  }
  return 0.5 * (1.0 + x);
}

}  // namespace

double place_of_share(PixelFilter filter, double width, double u) {
  // The fraction increases with the position, so a bisection finds it.
  double low = -1.0;
  double high = 1.0;
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return 0.5 * width * middle;
    (share_before(filter, middle) < u ? low : high) = middle;
  }
}

vec2 sample_point(const View& view, uint32_t generator, uint32_t index) {
  const uint32_t count = view.samples_per_pixel;
  const uint32_t row = (generator * (index + 1)) % (count + 1) - 1;
  const vec2 shares = vec2(2 * index + 1, 2 * row + 1) * static_cast<float>(0.5 / count);
  if (view.filter == PixelFilter::kBox && view.filter_width == 1.0F) return shares;
  const auto place = [&](float share) {
    return 0.5 + place_of_share(view.filter, static_cast<double>(view.filter_width), static_cast<double>(share));
  };
  return {place(shares.x), place(shares.y)};
}

uint32_t lattice_generator(uint32_t count) {
  // The search takes quadratic time. For more points, the integer nearest to the golden ratio that is coprime is good
  // enough (Niederreiter 1992, ch. 5).
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
