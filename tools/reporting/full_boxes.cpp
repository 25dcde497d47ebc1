// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/full_boxes.h"

#include <bit>
#include <vector>

#include "bvh/read_node.h"

namespace promin::report {
namespace {

Bounds bounds_of_leaf(const PackedScene& packed, const NodeChild& leaf) {
  Bounds bounds;
  for (uint32_t i = 0; i < leaf.count; ++i) bounds.extend(primitive_bounds(packed.primitives[leaf.first + i]));
  return bounds;
}

}  // namespace

FullNode pack_full_node(std::span<const Bounds> boxes, const uvec4& children) {
  FullNode node{};
  const std::array<uvec4*, 6> planes = {&node[0].frame,    &node[0].lo,    &node[0].hi,
                                        &node[0].children, &node[1].frame, &node[1].lo};
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto child = static_cast<int>(i);
      (*planes[static_cast<size_t>(axis)])[child] = std::bit_cast<uint32_t>(boxes[i].lo[axis]);
      (*planes[static_cast<size_t>(axis) + 3])[child] = std::bit_cast<uint32_t>(boxes[i].hi[axis]);
    }
  }
  node[1].hi = children;
  node[1].children = uvec4(boxes.size(), 0, 0, 0);
  return node;
}

PackedScene with_full_boxes(PackedScene packed) {
  const size_t count = packed.nodes.size();
  std::vector<Bounds> bounds(count);
  UnsetVector<layout::Node> full(2 * count);
  // A node comes after its parent: from the last to the first, each knows its children.
  for (size_t i = count; i-- > 0;) {
    const layout::Node& node = packed.nodes[i];
    std::vector<Bounds> boxes;
    for (uint32_t child = 0; child < child_count(node); ++child) {
      const NodeChild it = child_of(node, child);
      boxes.push_back(it.kind == ChildKind::kLeaf ? bounds_of_leaf(packed, it) : bounds[it.first]);
      bounds[i].extend(boxes.back());
    }
    const FullNode packed_node = pack_full_node(boxes, node.children);
    full[2 * i] = packed_node[0];
    full[2 * i + 1] = packed_node[1];
  }
  packed.nodes = std::move(full);
  packed.bvh.bytes = packed.nodes.size() * sizeof(layout::Node);
  return packed;
}

}  // namespace promin::report
