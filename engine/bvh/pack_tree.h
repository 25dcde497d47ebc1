// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "bvh/builder.h"
#include "core/unset_vector.h"
#include "shared/layout.h"

namespace promin {

/// A binary tree in the device's form: nodes with up to four children. The children's boxes are stored in bytes and
/// contain the boxes of the binary tree. `stack_size` is the largest number of entries on the stack of a traversal.
struct PackedTree {
  UnsetVector<layout::Node> nodes;
  uint32_t stack_size = 1;
};
PackedTree pack_tree(const Bvh& bvh);

/// Fits the boxes of a packed tree to new boxes of its primitives, which are not empty. The children stay. Each box
/// then contains the boxes of all primitives below it, as those of pack_tree() do. Returns the expected cost of a
/// random ray by the surface area heuristic. Its units are those of BvhStats::sah_cost, for nodes of up to four
/// children.
double refit_tree(std::span<layout::Node> nodes, std::span<const uint32_t> references, std::span<const Bounds> boxes);

}  // namespace promin
