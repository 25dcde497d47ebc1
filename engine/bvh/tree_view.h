// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "bvh/builder.h"
#include "shared/layout.h"

namespace promin {

/// A tree over the primitives of a scene in the device's form: the nodes of pack_tree and the references of its leaves.
/// The view does not own its memory.
struct TreeView {
  /// The nodes; at least one. A node comes after its parent.
  std::span<const layout::Node> nodes;
  /// The references of all leaves. Each reference is the index of a primitive in (object, primitive) order, without
  /// planes and degenerate triangles. Within a leaf the references are sorted by kind. A primitive may be in several
  /// leaves.
  std::span<const uint32_t> references;
  uint32_t primitive_count = 0;
  /// Number of entries that the traversal stack needs.
  uint32_t stack_size = 1;
  /// The kinds of primitive in the tree, as bits 1 << KIND_*.
  uint32_t kinds = 0;
  /// A hash of the tree's input: the records of the primitives.
  uint64_t geometry_hash = 0;
  BvhStats stats;
};

}  // namespace promin
