// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace promin {

// Tables that materials look up (shaders/shade/shading_records.glsl): a record for each cell between four entries, row
// by row of roughness, in it the entries at (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1). tools/make_lobe_table.py
// defines the entries.

/// Returns the table for metallic-roughness materials: how a lobe reflects light from all directions.
std::vector<glm::uvec4> make_lobe_table();
/// Returns the table for sheens: the part of the light from all directions that they reflect.
std::vector<glm::uvec4> make_sheen_table();

}  // namespace promin
