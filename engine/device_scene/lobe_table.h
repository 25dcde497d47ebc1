// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace promin {

// Tables that materials look up (shaders/shading_records.glsl): a record for each cell between four entries, row by row
// of roughness, in it the entries at (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1). tools/make_lobe_table.py says what
// an entry is.

/// Of metallic-roughness materials: what a lobe does with light from all around.
std::vector<glm::uvec4> make_lobe_table();
/// Of sheens: what they send of light from all around.
std::vector<glm::uvec4> make_sheen_table();

}  // namespace promin
