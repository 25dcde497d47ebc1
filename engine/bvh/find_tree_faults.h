// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "bvh/primitive_numbers.h"
#include "bvh/tree_view.h"
#include "promin/progress.h"

namespace promin {

/// The result of find_tree_faults.
struct TreeFaults {
  uint64_t count = 0;
  /// A sentence without a full stop about the first fault: about a leaf that is not sorted by kind, or else about the
  /// first faulty primitive in order.
  std::string first;
};

struct TreeFaultOptions {
  /// Number of threads; 0 uses one per core. The result does not depend on it.
  unsigned thread_count = 0;
  ProgressCallback progress = {};
};

/// Checks a tree against its primitives, which are in leaf order. A ray that hits a primitive must pass through the box
/// of a leaf with the primitive and through the boxes of all nodes above it, as the device decodes these boxes. A
/// primitive in one leaf must therefore lie within these boxes, and a primitive in several leaves must be covered
/// completely by the boxes of all of them together. Triangles are checked as polygons, other primitives by their
/// bounds. A split primitive may extend beyond the boxes by one fp32 rounding of its largest coordinate. This is a
/// tenth of the tolerance of the device's box test. Leaves must be sorted by kind. The nodes must form a tree over all
/// primitives, which BvhFile and pack_tree ensure.
TreeFaults find_tree_faults(const TreeView& tree, std::span<const layout::Primitive> primitives,
                            const PrimitiveNumbers& numbers, const TreeFaultOptions& options = {});

}  // namespace promin
