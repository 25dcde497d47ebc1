// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>

#include "render/pack_scene.h"

namespace promin {
namespace {

using layout::Node;

/// A child that no ray meets.
const Bounds kAbsent;

void set_child(Node& node, bool is_right, const Bounds& box, uint32_t reference) {
  const int lo = is_right ? 2 : 0;
  const int hi = lo + 1;
  node.x[lo] = box.lo.x;
  node.x[hi] = box.hi.x;
  node.y[lo] = box.lo.y;
  node.y[hi] = box.hi.y;
  node.z[lo] = box.lo.z;
  node.z[hi] = box.hi.z;
  node.children[is_right ? 1 : 0] = reference;
}

uint32_t leaf_reference(const BvhNode& leaf) {
  static_assert(kMaxLeafSize == 16, "the count has four bits");
  assert(leaf.count >= 1 && leaf.count <= kMaxLeafSize && leaf.first <= layout::CHILD_FIRST_MASK);
  return layout::CHILD_IS_LEAF | ((leaf.count - 1) << layout::CHILD_COUNT_SHIFT) | leaf.first;
}

}  // namespace

PackedTree pack_tree(const Bvh& bvh) {
  PackedTree tree;
  if (bvh.nodes.empty() || bvh.nodes[0].count > 0) {
    // A root must be an inner node: an only leaf becomes its left child.
    Node& root = tree.nodes.emplace_back();
    set_child(root, false, kAbsent, layout::CHILD_IS_LEAF);
    set_child(root, true, kAbsent, layout::CHILD_IS_LEAF);
    if (!bvh.nodes.empty()) set_child(root, false, bvh.nodes[0].bounds, leaf_reference(bvh.nodes[0]));
    return tree;
  }

  // Leaves live in their parents; inner nodes keep their order, parents before children.
  std::vector<uint32_t> device_index(bvh.nodes.size(), 0);
  uint32_t inner_count = 0;
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    if (bvh.nodes[i].count == 0) device_index[i] = inner_count++;
  }
  tree.nodes.resize(inner_count);
  std::vector<uint32_t> level(inner_count, 1);
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    if (bvh.nodes[i].count > 0) continue;
    const uint32_t index = device_index[i];
    // Each inner node on the way down leaves at most its farther child on the stack.
    tree.stack_size = std::max(tree.stack_size, level[index]);
    for (uint32_t side = 0; side < 2; ++side) {
      const uint32_t child_index = bvh.nodes[i].first + side;
      const BvhNode& child = bvh.nodes[child_index];
      const bool is_leaf = child.count > 0;
      set_child(tree.nodes[index], side == 1, child.bounds,
                is_leaf ? leaf_reference(child) : device_index[child_index]);
      if (!is_leaf) level[device_index[child_index]] = level[index] + 1;
    }
  }
  return tree;
}

}  // namespace promin
