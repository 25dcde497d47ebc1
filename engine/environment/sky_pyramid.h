// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "environment/sky_map.h"

namespace promin {

/// Returns the pyramid from which directions to a sky are chosen (docs/model.md, "Skies with shadows";
/// shaders/shade/sky_light.glsl). It has `levels` levels. Level i divides the octahedral map into 2^i x 2^i squares,
/// and each square has an entry: the bits of four floats, which are the shares of its quarters in its light, relative
/// to the largest. The quarters are in the order of x, then y. The entries of a level follow those of the level before.
/// The entries of the quarters of entry n are 4 n + 1 to 4 n + 4. A square without light has the shares 0. `map` has at
/// least 2^levels texels along a side.
std::vector<glm::uvec4> make_sky_pyramid(const SkyMap& map, uint32_t levels);

}  // namespace promin
