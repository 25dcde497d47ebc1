// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/srgb.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace promin {
namespace {

/// All smaller lights have the byte 0.
constexpr float kLeastLight = 0x1p-13F;

/// Returns the number of the interval that contains this light, counted from the interval of kLeastLight.
uint32_t interval_of(float light) {
  return (std::bit_cast<uint32_t>(light) >> 16) - (std::bit_cast<uint32_t>(kLeastLight) >> 16);
}

uint8_t compute_byte(float light) {
  return static_cast<uint8_t>(std::lround(255.0 * linear_to_srgb(static_cast<double>(light))));
}

/// Returns the least light that has at least this byte. The bits of positive floats increase with their values.
float find_least(uint8_t byte) {
  auto low = std::bit_cast<uint32_t>(0.0F);
  auto high = std::bit_cast<uint32_t>(1.0F);
  while (low < high) {
    const uint32_t middle = low + (high - low) / 2;
    if (compute_byte(std::bit_cast<float>(middle)) >= byte) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return std::bit_cast<float>(high);
}

}  // namespace

SrgbBytes::SrgbBytes() {
  for (size_t i = 0; i < 256; ++i) least_[i] = find_least(static_cast<uint8_t>(i));
  least_.back() = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < first_.size(); ++i) {
    const uint32_t bits = std::bit_cast<uint32_t>(kLeastLight) + (static_cast<uint32_t>(i) << 16);
    first_[i] = compute_byte(std::bit_cast<float>(bits));
  }
}

uint8_t SrgbBytes::operator()(float light) const {
  if (!(light >= kLeastLight)) return 0;
  light = std::min(light, 1.0F);
  uint8_t byte = first_[interval_of(light)];
  while (light >= least_[byte + size_t{1}]) ++byte;
  return byte;
}

}  // namespace promin
