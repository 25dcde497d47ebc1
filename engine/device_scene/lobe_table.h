// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace promin {

// Tables that the shaders of materials read (shaders/shade/shading_records.glsl). There is a record for each cell
// between four entries. The rows of the table are values of roughness. A record has the entries at (x, y), (x + 1, y),
// (x, y + 1), (x + 1, y + 1). tools/make_lobe_table.py defines the entries.

/// Returns the table for metallic-roughness materials, which describes how a lobe reflects light from all directions.
std::vector<glm::uvec4> make_lobe_table();
/// Returns the table for sheens: the fraction of the light from all directions that a sheen reflects.
std::vector<glm::uvec4> make_sheen_table();

}  // namespace promin
