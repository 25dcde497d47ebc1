// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "render/pack_scene.h"

namespace promin {
namespace {

using layout::Node;

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

  double step() const { return std::ldexp(1.0, static_cast<int>(exponent) - 127); }
  uint32_t byte_below(float plane) const {
    return static_cast<uint32_t>(std::floor((static_cast<double>(plane) - static_cast<double>(origin)) / step()));
  }
  uint32_t byte_above(float plane) const {
    return static_cast<uint32_t>(std::ceil((static_cast<double>(plane) - static_cast<double>(origin)) / step()));
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

class Packer {
 public:
  explicit Packer(const Bvh& bvh) : bvh_(bvh) {}

  PackedTree pack() {
    tree_.nodes.emplace_back();
    if (bvh_.nodes.empty()) {
      tree_.nodes[0].children = uvec4(layout::CHILD_ABSENT);
    } else if (bvh_.nodes[0].count > 0) {
      // A root must be an inner node: an only leaf becomes its child.
      tree_.nodes[0] = make_node(std::array{bvh_.nodes[0].bounds});
      tree_.nodes[0].children.x = leaf_reference(bvh_.nodes[0]);
    } else {
      open_.push_back({0, 0, 0});
    }
    while (!open_.empty()) {
      const Open next = open_.back();
      open_.pop_back();
      pack_node(next);
    }
    return std::move(tree_);
  }

 private:
  /// An inner node of the binary tree that gets a node of the device's.
  struct Open {
    uint32_t source = 0;
    uint32_t target = 0;
    /// Most entries on the traversal stack when a ray comes here.
    uint32_t stack_entries = 0;
  };

  void pack_node(const Open& open) {
    const Children children = widen(bvh_, bvh_.nodes[open.source]);
    std::array<Bounds, layout::NODE_WIDTH> boxes;
    for (uint32_t i = 0; i < children.count; ++i) boxes[i] = bvh_.nodes[children.nodes[i]].bounds;
    Node node = make_node(std::span(boxes).first(children.count));
    const uint32_t stack_entries = open.stack_entries + children.count - 1;
    tree_.stack_size = std::max(tree_.stack_size, stack_entries);
    for (uint32_t i = 0; i < children.count; ++i) {
      const BvhNode& child = bvh_.nodes[children.nodes[i]];
      if (child.count > 0) {
        node.children[static_cast<int>(i)] = leaf_reference(child);
        continue;
      }
      const auto target = static_cast<uint32_t>(tree_.nodes.size());
      tree_.nodes.emplace_back();
      node.children[static_cast<int>(i)] = target;
      open_.push_back({children.nodes[i], target, stack_entries});
    }
    tree_.nodes[open.target] = node;
  }

  const Bvh& bvh_;
  PackedTree tree_;
  std::vector<Open> open_;
};

}  // namespace

PackedTree pack_tree(const Bvh& bvh) {
  return Packer(bvh).pack();
}

}  // namespace promin
