// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace promin {

// Corners of triangles are numbered 3 * triangle + (0, 1, 2). An edge has the number of the corner at which it starts.

/// The value that stands for no corner and no edge.
inline constexpr uint32_t kNoCorner = std::numeric_limits<uint32_t>::max();

inline uint32_t next_corner(uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}
inline uint32_t last_corner(uint32_t corner) {
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}

/// Returns for each edge the edge of another triangle that runs in the opposite direction between the same vertices;
/// kNoCorner if there is none. If there are several, the first edge is paired with the first opposite edge, the second
/// with the second. `vertices` has the vertex of each corner, below `vertex_count`; kNoCorner at all three corners
/// excludes a triangle. No other triangle may have a vertex twice. The result does not depend on the number of threads.
std::vector<uint32_t> find_edge_neighbors(std::span<const uint32_t> vertices, uint32_t vertex_count);

}  // namespace promin
