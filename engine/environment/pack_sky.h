// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "promin/environment.h"

namespace promin {

/// A sky in the form that shaders/shade/environment.glsl reads.
struct PackedSky {
  /// Side of the sharpest level in texels, a power of two from 128 to 512; 0 if there is no sky.
  uint32_t side = 0;
  /// The levels of shaders/shade/sky_levels.def, one after the other, then the pyramid. A level has side + 2 rows of
  /// side + 1 entries: its texels with a border of one texel (environment/sky_map.h). An entry has two neighbouring
  /// texels of a row. A texel is three half floats, stored from the lowest bits on.
  std::vector<glm::uvec4> texels;
  /// The pyramid that follows the levels in `texels` (environment/sky_pyramid.h): its first entry and its number of
  /// levels.
  uint32_t first_of_pyramid = 0;
  uint32_t pyramid_levels = 0;
  /// Coefficients of the irradiance divided by pi; w is 0. For the unit normal (x, y, z) they are the coefficients of
  /// 1, y, z, x, xy, yz, 3zz - 1, zx and xx - yy.
  std::array<vec4, 9> irradiance{};
};

/// Returns the number of texels along a side of a level.
uint32_t side_of_level(uint32_t sharpest_side, uint32_t level);

/// Prefilters an environment's sky: each texel of level i is the mean over a GGX lobe of its roughness, viewed along
/// its normal. This is the radiance that a rough white metal reflects. Uses up to `thread_count` threads (0: all
/// cores); the result does not depend on their number. Empty if there is no sky.
PackedSky pack_sky(const Environment& environment, unsigned thread_count = 0);

/// Returns the size in bytes of the texels of pack_sky() without computing them.
uint64_t packed_sky_bytes(const Environment& environment);

}  // namespace promin
