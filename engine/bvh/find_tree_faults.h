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
  /// A sentence without a full stop about the first fault: a leaf that is not sorted by kind, else the first primitive
  /// in order.
  std::string first;
};

struct TreeFaultOptions {
  /// Number of threads; 0 uses one per core. The result does not depend on it.
  unsigned thread_count = 0;
  ProgressCallback progress = {};
};

/// Checks a tree against the primitives that its leaves refer to, in leaf order. A ray that hits a primitive must pass
/// through the boxes, as the device decodes them, of a leaf with the primitive and of all nodes above it. A primitive
/// in one leaf must therefore lie within these boxes, and a primitive in several leaves must be covered completely by
/// the boxes of all of them together. Triangles are checked as polygons, other primitives by their bounds. Split
/// primitives may lie outside by one rounding of fp32 of their largest coordinate, a tenth of the tolerance of the
/// device's box test. Leaves must be sorted by kind. The nodes must form a tree over all primitives, which BvhFile and
/// pack_tree ensure.
TreeFaults find_tree_faults(const TreeView& tree, std::span<const layout::Primitive> primitives,
                            const PrimitiveNumbers& numbers, const TreeFaultOptions& options = {});

}  // namespace promin
