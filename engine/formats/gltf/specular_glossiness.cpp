// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/specular_glossiness.h"

#include <array>
#include <cmath>

namespace promin {

void take_glossiness(std::span<uint32_t> texels, double glossiness_factor) {
  std::array<uint32_t, 256> roughness{};
  for (size_t glossiness = 0; glossiness < roughness.size(); ++glossiness) {
    roughness[glossiness] =
        static_cast<uint32_t>(std::lround(255.0 - glossiness_factor * static_cast<double>(glossiness)));
  }
  for (uint32_t& texel : texels) texel = 0xFF000000 | roughness[texel >> 24] << 8;
}

}  // namespace promin
