// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/scrambled_points.h"

#include <algorithm>

#include "core/hash.h"
#include "device_scene/sampling.h"

namespace promin {
namespace {

uint32_t reverse_bits(uint32_t x) {
  x = x << 16 | x >> 16;
  x = (x & 0x00FF00FFU) << 8 | (x & 0xFF00FF00U) >> 8;
  x = (x & 0x0F0F0F0FU) << 4 | (x & 0xF0F0F0F0U) >> 4;
  x = (x & 0x33333333U) << 2 | (x & 0xCCCCCCCCU) >> 2;
  return (x & 0x55555555U) << 1 | (x & 0xAAAAAAAAU) >> 1;
}

/// Permutes the bits of x so that each bit of the result depends only on lower bits of x (Laine and Karras, "Stratified
/// Sampling for Stochastic Transparency", 2011, with Burley's constants).
uint32_t permute_upwards(uint32_t x, uint32_t seed) {
  x += seed;
  x ^= x * 0x6C50B47CU;
  x ^= x * 0xB82F1E52U;
  x ^= x * 0xC7AFE638U;
  x ^= x * 0x8D22F6E6U;
  return x;
}

/// Returns a number of Sobol's second dimension, as a fraction of 2^32. Its direction numbers are the rows of Pascal's
/// triangle mod 2.
uint32_t second_sobol(uint32_t index) {
  uint32_t result = 0;
  for (uint32_t direction = 0x80000000U; index != 0; index >>= 1, direction ^= direction >> 1) {
    if ((index & 1U) != 0) result ^= direction;
  }
  return result;
}

/// Returns the middle of one of 2^23 intervals of 0...1.
float fraction(uint32_t bits) {
  return static_cast<float>(bits >> 9) * 0x1p-23F + 0x1p-24F;
}

}  // namespace

uint32_t key_of_points(uint32_t seed, uint32_t dimension) {
  return mix_bits(dimension + mix_bits(seed));
}

ScrambledPoints::ScrambledPoints(const uvec2& pixel, uint32_t seed) {
  for (uint32_t axis = 0; axis < 2; ++axis) {
    seeds_[axis] = mix_bits(pixel.x + mix_bits(pixel.y + key_of_points(seed, axis)));
  }
}

vec2 ScrambledPoints::at(uint32_t index) const {
  // The first dimension is the index with reversed bits, so the bits have the order that the permutation needs.
  const uint32_t x = reverse_bits(permute_upwards(index, seeds_[0]));
  const uint32_t y = reverse_bits(permute_upwards(reverse_bits(second_sobol(index)), seeds_[1]));
  return {fraction(x), fraction(y)};
}

FilterPlaces::FilterPlaces(const View& view) {
  const auto width = static_cast<double>(view.filter_width);
  for (uint32_t i = 0; i <= kSteps; ++i) {
    places_[i] = static_cast<float>(0.5 + place_of_share(view.filter, width, static_cast<double>(i) / kSteps));
  }
}

float FilterPlaces::place(float share) const {
  const float x = share * static_cast<float>(kSteps);
  const uint32_t step = std::min(static_cast<uint32_t>(x), kSteps - 1);
  return places_[step] + (x - static_cast<float>(step)) * (places_[step + 1] - places_[step]);
}

}  // namespace promin
