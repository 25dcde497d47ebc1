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

/// What find_tree_faults finds.
struct TreeFaults {
  uint64_t count = 0;
  /// A sentence without a full stop about the first fault: a leaf that is not sorted by kind, or else the first
  /// primitive in order.
  std::string first;
};

struct TreeFaultOptions {
  /// 0 takes one thread per core. What is found does not depend on it.
  unsigned thread_count = 0;
  ProgressCallback progress = {};
};

/// Checks a tree against the primitives that its leaves refer to, in leaf order. A ray that meets a primitive must come
/// to it through the boxes, as the device decodes them, of a leaf and of all nodes above it. So a primitive in one leaf
/// must lie within these boxes, and of a primitive in several leaves nothing may be left when what each leaf's boxes
/// hold is taken away. A triangle counts as the polygon that it is, other primitives by their bounds. Split primitives
/// may lie outside by one rounding of fp32 of their largest coordinate, a tenth of what the device's box test allows
/// for. Leaves must be sorted by kind. That the nodes are a tree over all primitives is taken for granted (BvhFile and
/// pack_tree ensure it).
TreeFaults find_tree_faults(const TreeView& tree, std::span<const layout::Primitive> primitives,
                            const PrimitiveNumbers& numbers, const TreeFaultOptions& options = {});

}  // namespace promin
