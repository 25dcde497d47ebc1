// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/samples.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace promin::oracle {
namespace {

using Directions = std::array<uint32_t, 32>;

/// The first dimension has one bit in each direction number. In the second, each number is the one before, added to
/// itself shifted by one bit.
std::array<Directions, 2> make_directions() {
  std::array<Directions, 2> v{};
  v[0][0] = v[1][0] = 0x80000000U;
  for (size_t i = 1; i < 32; ++i) {
    v[0][i] = v[0][i - 1] >> 1;
    v[1][i] = v[1][i - 1] ^ v[1][i - 1] >> 1;
  }
  return v;
}

uint32_t mirrored(uint32_t x) {
  uint32_t result = 0;
  for (int bit = 0; bit < 32; ++bit) result |= (x >> bit & 1U) << (31 - bit);
  return result;
}

/// Wellons's lowbias32.
uint32_t hashed(uint32_t x) {
  for (const auto& [shift, factor] : {std::array<uint32_t, 2>{16, 0x7FEB352D}, {15, 0x846CA68B}}) {
    x = (x ^ x >> shift) * factor;
  }
  return x ^ x >> 16;
}

}  // namespace

uint32_t sobol(uint32_t index, int dimension) {
  static const std::array<Directions, 2> kDirections = make_directions();
  uint32_t result = 0;
  for (size_t bit = 0; bit < 32; ++bit) {
    if ((index >> bit & 1U) != 0) result ^= kDirections[static_cast<size_t>(dimension)][bit];
  }
  return result;
}

uint32_t joint_index(uint32_t number) {
  constexpr std::array<uint32_t, 10> kColumns = {1, 2, 6, 13, 27, 45, 111, 188, 274, 687};
  uint32_t index = 0;
  for (uint32_t bit = 0; bit < 32; ++bit) {
    if ((number >> bit & 1U) != 0) index ^= bit < kColumns.size() ? kColumns[bit] : 1U << bit;
  }
  return index;
}

uint32_t scramble(uint32_t x, uint32_t seed) {
  uint32_t reversed = mirrored(x) + seed;
  for (const uint32_t factor : {0x6C50B47CU, 0xB82F1E52U, 0xC7AFE638U, 0x8D22F6E6U}) reversed ^= reversed * factor;
  return mirrored(reversed);
}

std::array<uint32_t, 2> sample_pair_bits(const SampleId& id, uint32_t pair) {
  const uint32_t key = hashed(id.pixel.x + hashed(id.pixel.y + hashed(2 + hashed(id.seed))));
  const uint32_t seed = hashed(key + 3 * pair);
  const bool is_joint = id.is_refined && pair == 0;
  const uint32_t index = is_joint ? joint_index(id.number) : scramble(id.number, seed);
  std::array<uint32_t, 2> bits{};
  for (uint32_t axis = 0; axis < 2; ++axis) {
    bits[axis] = scramble(sobol(index, static_cast<int>(axis)), hashed(seed + 1 + axis));
  }
  return bits;
}

std::array<Real, 2> sample_pair(const SampleId& id, uint32_t pair) {
  const auto [x, y] = sample_pair_bits(id, pair);
  return {((x >> 9) + 0.5L) / 8388608, ((y >> 9) + 0.5L) / 8388608};
}

std::array<Real, 2> place_on_disc(const std::array<Real, 2>& u) {
  const Real x = 2 * u[0] - 1;
  const Real y = 2 * u[1] - 1;
  constexpr Real kQuarter = std::numbers::pi_v<Real> / 4;
  const bool is_steep = std::abs(x) < std::abs(y);
  const Real radius = is_steep ? y : x;
  const Real angle = is_steep ? 2 * kQuarter - kQuarter * (x / y) : kQuarter * (y / x);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

Vector place_in_cone(const Vector& axis, Real half_angle, const std::array<Real, 2>& u) {
  const auto [x, y] = place_on_disc(u);
  // The chord from the pole of the unit sphere to a circle of latitude has a square in proportion to the area between
  // them.
  const Real half_chord = std::sqrt(x * x + y * y) * std::sin(half_angle / 2);
  const Real latitude = 2 * std::asin(std::min(half_chord, Real(1)));
  const Real cosine = std::cos(latitude);
  const Real sine = std::sin(latitude);
  const Real angle = std::atan2(y, x);
  const Vector helper = std::abs(axis.x) < 0.57L ? Vector(1, 0, 0) : Vector(0, 1, 0);
  const Vector across = glm::normalize(glm::cross(axis, helper));
  const Vector along = glm::cross(axis, across);
  return sine * (std::cos(angle) * across + std::sin(angle) * along) + cosine * axis;
}

}  // namespace promin::oracle
