// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "promin/environment.h"

namespace promin {

/// A sky as shaders/environment.glsl reads it.
struct PackedSky {
  /// Texels of the sharpest level along each side; 0 where there is no sky.
  uint32_t side = 0;
  std::vector<glm::uvec4> texels;
  /// Coefficients of the light that a surface gets, over pi; w is 0.
  std::array<vec4, 9> irradiance{};
};

/// Prefilters an environment's sky on all cores. Empty where it has none.
PackedSky pack_sky(const Environment& environment);

}  // namespace promin
