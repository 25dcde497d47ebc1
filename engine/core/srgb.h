// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

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

}  // namespace promin
