// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace promin {

// Functions for the sRGB transfer curve (IEC 61966-2-1) in both directions, without clamping.

/// Returns the linear light of an sRGB value in 0...1.
inline double srgb_to_linear(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

/// Returns the sRGB value of linear light in 0...1.
inline double linear_to_srgb(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
}

/// The sRGB bytes of linear light, by a table. The bytes equal 255 times linear_to_srgb, rounded, for each float.
class SrgbBytes {
 public:
  SrgbBytes();

  /// Returns the byte of light, which counts as 0 below 0 and as 1 above 1.
  uint8_t operator()(float light) const;

 private:
  /// The least light of each byte, and infinity after the last.
  std::array<float, 257> least_{};
  /// The byte of the least light in each interval of floats that have equal upper halves. The first interval begins at
  /// kLeastLight, and the last contains 1.
  std::array<uint8_t, 13 * 128 + 1> first_{};
};

}  // namespace promin
