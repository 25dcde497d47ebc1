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
  /// A sentence without a full stop; of a leaf that is not sorted by kind, else of the first primitive in order.
  std::string first;
};

struct TreeFaultOptions {
  /// 0: one per core. What is found does not depend on it.
  unsigned thread_count = 0;
  ProgressCallback progress = {};
};

/// Holds a tree against the primitives that its leaves refer to, in leaf order, whoever built it: a ray that meets a
/// primitive must come to it through the boxes, as the device decodes them, of a leaf and of all nodes above it. A
/// primitive in one leaf must lie within these boxes; of one in several leaves nothing may be left when what each
/// leaf's boxes hold is taken away. A triangle counts as the polygon that it is, other primitives by their bounds.
/// Split primitives may lie outside by one rounding of fp32 of their largest coordinate, a tenth of what the device's
/// box test allows for. Also checks that leaves are sorted by kind. That the nodes are a tree over all primitives is
/// taken for granted (BvhFile, pack_tree).
TreeFaults find_tree_faults(const TreeView& tree, std::span<const layout::Primitive> primitives,
                            const PrimitiveNumbers& numbers, const TreeFaultOptions& options = {});

}  // namespace promin
