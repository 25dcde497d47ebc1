// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/specular_glossiness.h"

#include <array>
#include <cmath>

namespace promin {
namespace {

/// IEC 61966-2-1.
double decode_srgb(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

}  // namespace

dvec3 take_glossiness(std::span<uint32_t> texels, double glossiness_factor) {
  std::array<uint32_t, 256> roughness{};
  for (size_t glossiness = 0; glossiness < roughness.size(); ++glossiness) {
    roughness[glossiness] =
        static_cast<uint32_t>(std::lround(255.0 - glossiness_factor * static_cast<double>(glossiness)));
  }
  // How often each byte occurs in each channel.
  std::array<std::array<uint64_t, 256>, 3> counts{};
  for (uint32_t& texel : texels) {
    for (uint32_t channel = 0; channel < 3; ++channel) ++counts[channel][(texel >> (8 * channel)) & 0xFF];
    texel = 0xFF000000 | roughness[texel >> 24] << 8;
  }
  dvec3 mean(0.0);
  for (int channel = 0; channel < 3; ++channel) {
    for (size_t code = 0; code < 256; ++code) {
      const auto count = static_cast<double>(counts[static_cast<size_t>(channel)][code]);
      mean[channel] += count * decode_srgb(static_cast<double>(code) / 255.0);
    }
  }
  return mean / static_cast<double>(texels.size());
}

}  // namespace promin
