// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "bvh/builder.h"
#include "layout.h"

namespace promin {

/// A tree over the primitives of a scene, as the device takes it: pack_tree's nodes, and what its leaves hold. Keeps
/// nothing alive.
struct TreeView {
  /// At least one. A node comes after its parent.
  std::span<const layout::Node> nodes;
  /// What the leaves' ranges are of: primitives by their place in (object, primitive) order, planes and degenerate
  /// triangles left out. Sorted by kind in each leaf. A primitive may be in several leaves.
  std::span<const uint32_t> references;
  uint32_t primitive_count = 0;
  /// Entries that the traversal stack needs.
  uint32_t stack_size = 1;
  /// Of the kinds of primitive that it holds the bits 1 << KIND_*.
  uint32_t kinds = 0;
  /// Of all that the tree depends on: the records of what it is over.
  uint64_t geometry_hash = 0;
  BvhStats stats;
};

}  // namespace promin
