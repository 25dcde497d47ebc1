// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "render/pack_scene.h"

namespace promin {
namespace {

using layout::Node;

/// At least this many subtrees of a large tree, so that threads which finish early find another.
constexpr size_t kSubtrees = 256;

/// Indices of binary nodes.
struct Children {
  std::array<uint32_t, layout::NODE_WIDTH> nodes{};
  uint32_t count = 0;
};

/// What becomes of an inner node of the binary tree: its children, the inner ones of largest area replaced by their
/// own children as long as there is room.
Children widen(const Bvh& bvh, const BvhNode& parent) {
  Children children{{parent.first, parent.first + 1}, 2};
  while (children.count < layout::NODE_WIDTH) {
    uint32_t largest = layout::NODE_WIDTH;
    double largest_area = -1.0;
    for (uint32_t i = 0; i < children.count; ++i) {
      const BvhNode& child = bvh.nodes[children.nodes[i]];
      const double area = child.bounds.half_area();
      if (child.count == 0 && area > largest_area) {
        largest = i;
        largest_area = area;
      }
    }
    if (largest == layout::NODE_WIDTH) break;
    const uint32_t first = bvh.nodes[children.nodes[largest]].first;
    children.nodes[largest] = first;
    children.nodes[children.count++] = first + 1;
  }
  return children;
}

/// An axis of the node's grid: planes at origin + byte * 2^(exponent - 127).
struct Axis {
  float origin = 0.0F;
  uint32_t exponent = 1;

  uint32_t byte_below(float plane) const { return static_cast<uint32_t>(steps_to(plane)); }
  uint32_t byte_above(float plane) const {
    const double steps = steps_to(plane);
    const auto whole = static_cast<uint32_t>(steps);
    return whole + (whole < steps ? 1 : 0);
  }
  /// Exact, as the step is a power of two; not negative for planes from the origin on.
  double steps_to(float plane) const {
    const auto inverse_step = std::bit_cast<double>(uint64_t{1023 + 127 - exponent} << 52);
    return (static_cast<double>(plane) - static_cast<double>(origin)) * inverse_step;
  }
};

/// The finest grid that reaches from lo to hi.
Axis make_axis(float lo, float hi) {
  Axis axis;
  axis.origin = lo;
  const double extent = static_cast<double>(hi) - static_cast<double>(lo);
  if (extent > 0.0) axis.exponent = static_cast<uint32_t>(std::max(1, std::ilogb(extent) - 7 + 127));
  while (axis.byte_above(hi) > 255) ++axis.exponent;
  return axis;
}

uint32_t leaf_reference(const BvhNode& leaf) {
  static_assert(kMaxLeafSize == 16, "the count has four bits");
  assert(leaf.count >= 1 && leaf.count <= kMaxLeafSize && leaf.first <= layout::CHILD_FIRST_MASK);
  return layout::CHILD_IS_LEAF | ((leaf.count - 1) << layout::CHILD_COUNT_SHIFT) | leaf.first;
}

/// A node of these boxes; its children are left absent.
Node make_node(std::span<const Bounds> boxes) {
  Bounds all;
  for (const Bounds& box : boxes) all.extend(box);
  Node node{};
  node.children = uvec4(layout::CHILD_ABSENT);
  for (int axis = 0; axis < 3; ++axis) {
    const Axis grid = make_axis(all.lo[axis], all.hi[axis]);
    node.frame[axis] = std::bit_cast<uint32_t>(grid.origin);
    node.frame.w |= grid.exponent << (8 * axis);
    uint32_t& hi = axis == 0 ? node.lo.w : node.hi[axis - 1];
    for (size_t i = 0; i < boxes.size(); ++i) {
      node.lo[axis] |= grid.byte_below(boxes[i].lo[axis]) << (8 * i);
      hi |= grid.byte_above(boxes[i].hi[axis]) << (8 * i);
    }
  }
  return node;
}

/// An inner node of the binary tree that gets a node of the device's.
struct Open {
  uint32_t source = 0;
  uint32_t target = 0;
  /// Most entries on the traversal stack when a ray comes here.
  uint32_t stack_entries = 0;
};

/// Makes the node of `open`, and room for those of its children, which are put on `open_children`.
void pack_node(const Bvh& bvh, const Open& open, PackedTree& tree, std::vector<Open>& open_children) {
  const Children children = widen(bvh, bvh.nodes[open.source]);
  std::array<Bounds, layout::NODE_WIDTH> boxes;
  for (uint32_t i = 0; i < children.count; ++i) boxes[i] = bvh.nodes[children.nodes[i]].bounds;
  Node node = make_node(std::span(boxes).first(children.count));
  const uint32_t stack_entries = open.stack_entries + children.count - 1;
  tree.stack_size = std::max(tree.stack_size, stack_entries);
  for (uint32_t i = 0; i < children.count; ++i) {
    const BvhNode& child = bvh.nodes[children.nodes[i]];
    if (child.count > 0) {
      node.children[static_cast<int>(i)] = leaf_reference(child);
      continue;
    }
    const auto target = static_cast<uint32_t>(tree.nodes.size());
    tree.nodes.emplace_back();
    node.children[static_cast<int>(i)] = target;
    open_children.push_back({children.nodes[i], target, stack_entries});
  }
  tree.nodes[open.target] = node;
}

/// The nodes below one, which becomes node 0.
PackedTree pack_subtree(const Bvh& bvh, Open root) {
  root.target = 0;
  PackedTree tree;
  tree.nodes.emplace_back();
  std::vector<Open> open = {root};
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    pack_node(bvh, next, tree, open);
  }
  return tree;
}

/// Puts a subtree's root at node `root`, the others from node `first` on.
void place_subtree(PackedTree& subtree, uint32_t root, size_t first, PackedTree& tree) {
  for (Node& node : subtree.nodes) {
    for (int i = 0; i < static_cast<int>(layout::NODE_WIDTH); ++i) {
      // Absent ones have the bit of a leaf too.
      if ((node.children[i] & layout::CHILD_IS_LEAF) == 0) node.children[i] += static_cast<uint32_t>(first) - 1;
    }
  }
  tree.nodes[root] = subtree.nodes.front();
  std::copy(subtree.nodes.begin() + 1, subtree.nodes.end(), tree.nodes.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace

// The top is packed level by level until there are enough subtrees for all threads; they follow it in their order, so
// the nodes do not depend on how many threads there are.
PackedTree pack_tree(const Bvh& bvh) {
  PackedTree tree;
  tree.nodes.emplace_back();
  if (bvh.nodes.empty()) {
    tree.nodes[0] = {};
    tree.nodes[0].children = uvec4(layout::CHILD_ABSENT);
    return tree;
  }
  if (bvh.nodes[0].count > 0) {
    // A root must be an inner node: an only leaf becomes its child.
    tree.nodes[0] = make_node(std::array{bvh.nodes[0].bounds});
    tree.nodes[0].children.x = leaf_reference(bvh.nodes[0]);
    return tree;
  }
  std::vector<Open> open = {Open()};
  while (!open.empty() && open.size() < kSubtrees) {
    std::vector<Open> next_level;
    for (const Open& node : open) pack_node(bvh, node, tree, next_level);
    open = std::move(next_level);
  }
  std::vector<PackedTree> subtrees(open.size());
  for_each_index(open.size(), 0, [&](size_t i) { subtrees[i] = pack_subtree(bvh, open[i]); });
  std::vector<size_t> starts = {tree.nodes.size()};
  for (const PackedTree& subtree : subtrees) {
    starts.push_back(starts.back() + subtree.nodes.size() - 1);
    tree.stack_size = std::max(tree.stack_size, subtree.stack_size);
  }
  tree.nodes.resize(starts.back());
  for_each_index(open.size(), 0, [&](size_t i) { place_subtree(subtrees[i], open[i].target, starts[i], tree); });
  return tree;
}

}  // namespace promin
