// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "render/pack_scene.h"

namespace promin {
namespace {

using layout::Node;

/// Indices of binary nodes.
struct Children {
  std::array<uint32_t, layout::NODE_WIDTH> nodes{};
  uint32_t count = 0;
};

/// Which inner nodes of the binary tree become wide ones, so that the expected cost of a ray is the least: dynamic
/// programming over how many slots of a wide node a subtree takes (Ylitie, Karras, Laine, "Efficient Incoherent Ray
/// Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.1; the leaves stay as the builder made them).
class Collapse {
 public:
  explicit Collapse(const Bvh& bvh) : bvh_(bvh), plans_(bvh.nodes.size()) {
    // Nodes come after their parents.
    for (size_t i = bvh.nodes.size(); i-- > 0;) plans_[i] = plan(bvh.nodes[i]);
  }

  /// Of the wide node that an inner node becomes.
  Children children_of(uint32_t node) const {
    Children children;
    divide(node, layout::NODE_WIDTH, children);
    return children;
  }

 private:
  /// What a subtree costs in 1...NODE_WIDTH slots (at index slots - 1), and how many of them its first child then
  /// takes; 0: it does not use the last slot.
  struct Plan {
    std::array<float, layout::NODE_WIDTH> cost{};
    std::array<uint8_t, layout::NODE_WIDTH> first_slots{};
  };

  Plan plan(const BvhNode& node) const {
    Plan result;
    const double area = node.bounds.half_area();
    if (node.count > 0) {
      result.cost.fill(static_cast<float>(kTestCost * area * node.count));
      return result;
    }
    const auto& first = plans_[node.first].cost;
    const auto& second = plans_[node.first + 1].cost;
    for (uint32_t slots = 2; slots <= layout::NODE_WIDTH; ++slots) {
      float& least = result.cost[slots - 1];
      least = std::numeric_limits<float>::infinity();
      for (uint32_t of_first = 1; of_first < slots; ++of_first) {
        const float cost = first[of_first - 1] + second[slots - of_first - 1];
        if (!(cost < least)) continue;
        least = cost;
        result.first_slots[slots - 1] = static_cast<uint8_t>(of_first);
      }
    }
    // In one slot it is a wide node of its own.
    result.cost[0] = static_cast<float>(kNodeCost * area) + result.cost[layout::NODE_WIDTH - 1];
    for (uint32_t slots = 2; slots < layout::NODE_WIDTH; ++slots) {
      if (result.cost[slots - 2] > result.cost[slots - 1]) continue;
      result.cost[slots - 1] = result.cost[slots - 2];
      result.first_slots[slots - 1] = 0;
    }
    return result;
  }

  void divide(uint32_t node, uint32_t slots, Children& children) const {
    const uint32_t of_first = std::max<uint32_t>(1, plans_[node].first_slots[slots - 1]);
    place(bvh_.nodes[node].first, of_first, children);
    place(bvh_.nodes[node].first + 1, slots - of_first, children);
  }

  void place(uint32_t node, uint32_t slots, Children& children) const {
    while (slots > 1 && plans_[node].first_slots[slots - 1] == 0) --slots;
    if (slots > 1) return divide(node, slots, children);
    children.nodes[children.count++] = node;
  }

  const Bvh& bvh_;
  std::vector<Plan> plans_;
};

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

/// A node of these boxes; its children are left out.
Node make_node(std::span<const Bounds> boxes) {
  Bounds all;
  for (const Bounds& box : boxes) all.extend(box);
  Node node{};
  node.frame.w = static_cast<uint32_t>(boxes.size()) << 24;
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
  explicit Packer(const Bvh& bvh) : bvh_(bvh), collapse_(bvh) {}

  PackedTree pack() {
    tree_.nodes.emplace_back();
    if (!bvh_.nodes.empty() && bvh_.nodes[0].count > 0) {
      // A root must be an inner node: an only leaf becomes its child.
      tree_.nodes[0] = make_node(std::array{bvh_.nodes[0].bounds});
      tree_.nodes[0].children.x = leaf_reference(bvh_.nodes[0]);
    } else if (!bvh_.nodes.empty()) {
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
    /// Most families on the traversal stack when a ray leaves this node: one for each node above.
    uint32_t stack_entries = 0;
  };

  void pack_node(const Open& open) {
    const Children children = collapse_.children_of(open.source);
    std::array<Bounds, layout::NODE_WIDTH> boxes;
    for (uint32_t i = 0; i < children.count; ++i) boxes[i] = bvh_.nodes[children.nodes[i]].bounds;
    Node node = make_node(std::span(boxes).first(children.count));
    tree_.stack_size = std::max(tree_.stack_size, open.stack_entries);
    for (uint32_t i = 0; i < children.count; ++i) {
      const BvhNode& child = bvh_.nodes[children.nodes[i]];
      if (child.count > 0) {
        node.children[static_cast<int>(i)] = leaf_reference(child);
        continue;
      }
      const auto target = static_cast<uint32_t>(tree_.nodes.size());
      tree_.nodes.emplace_back();
      node.children[static_cast<int>(i)] = target;
      open_.push_back({children.nodes[i], target, open.stack_entries + 1});
    }
    tree_.nodes[open.target] = node;
  }

  const Bvh& bvh_;
  Collapse collapse_;
  PackedTree tree_;
  std::vector<Open> open_;
};

}  // namespace

PackedTree pack_tree(const Bvh& bvh) {
  return Packer(bvh).pack();
}

}  // namespace promin
