// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "bvh/builder.h"
#include "layout.h"

namespace promin {

/// A tree over the primitives of a scene, as the device takes it: pack_tree's nodes, and what its leaves hold. A view
/// keeps nothing alive.
struct TreeView {
  /// At least one. A node comes after its parent.
  std::span<const layout::Node> nodes;
  /// The references that the leaves' ranges count: each is the place of a primitive in (object, primitive) order, with
  /// planes and degenerate triangles left out. They are sorted by kind in each leaf. A primitive may be in several
  /// leaves.
  std::span<const uint32_t> references;
  uint32_t primitive_count = 0;
  /// Entries that the traversal stack needs.
  uint32_t stack_size = 1;
  /// The kinds of primitive that the tree holds, as bits 1 << KIND_*.
  uint32_t kinds = 0;
  /// A hash of all that the tree depends on: the records of the primitives that it was built over.
  uint64_t geometry_hash = 0;
  BvhStats stats;
};

}  // namespace promin
