// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/pack_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "bvh/read_node.h"
#include "core/parallel.h"

namespace promin {
namespace {

using layout::Node;

/// The smallest number of subtrees into which a large tree is divided, so that threads that finish early find more
/// work.
constexpr size_t kSubtrees = 256;

/// The children of a wide node, as indices of binary nodes.
struct Children {
  std::array<uint32_t, layout::NODE_WIDTH> nodes{};
  uint32_t count = 0;
};

/// Chooses the inner nodes of the binary tree that become wide nodes, so that the expected cost of a ray is minimal. It
/// uses dynamic programming over the number of slots of a wide node that a subtree occupies (Ylitie, Karras, Laine,
/// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.1; the leaves stay as
/// the builder made them).
class Collapse {
 public:
  explicit Collapse(const Bvh& bvh) : bvh_(bvh), root_area_(bvh.nodes[0].bounds.half_area()), plans_(bvh.nodes.size()) {
    if (!(root_area_ > 0.0)) root_area_ = 1.0;
    // The top is opened level by level, until there are enough subtrees for all threads.
    std::vector<uint32_t> top = {0};
    size_t planned = 0;
    for (; planned < top.size() && top.size() - planned < kSubtrees; ++planned) push_children(top[planned], top);
    const std::span<const uint32_t> subtrees = std::span(top).subspan(planned);
    for_each_index(subtrees.size(), 0, [&](size_t i) {
      std::vector<uint32_t> below = {subtrees[i]};
      for (size_t k = 0; k < below.size(); ++k) push_children(below[k], below);
      plan_upwards(below);
    });
    plan_upwards(std::span(top).first(planned));
  }

  /// Returns the children of the wide node that replaces an inner node.
  Children children_of(uint32_t node) const {
    Children children;
    divide(node, layout::NODE_WIDTH, children);
    return children;
  }

 private:
  void push_children(uint32_t node, std::vector<uint32_t>& nodes) const {
    const uint32_t first = bvh_.nodes[node].first;
    if (bvh_.nodes[node].count == 0) nodes.insert(nodes.end(), {first, first + 1});
  }

  /// Plans these nodes from the last to the first, because a node comes after its parent.
  void plan_upwards(std::span<const uint32_t> nodes) {
    for (size_t i = nodes.size(); i-- > 0;) plans_[nodes[i]] = plan(bvh_.nodes[nodes[i]]);
  }

  /// For a subtree in 1...NODE_WIDTH slots (at index slots - 1): its cost, and the number of slots that its first child
  /// then occupies. 0 means that the subtree does not use the last slot.
  struct Plan {
    std::array<float, layout::NODE_WIDTH> cost;
    std::array<uint8_t, layout::NODE_WIDTH> first_slots;
  };

  Plan plan(const BvhNode& node) const {
    Plan result = {};
    const double area = node.bounds.half_area() / root_area_;
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
    // A subtree in one slot becomes a wide node of its own.
    result.cost[0] = static_cast<float>(kNodeCost * area) + result.cost[layout::NODE_WIDTH - 1];
    for (uint32_t slots = 2; slots < layout::NODE_WIDTH; ++slots) {
      // At equal cost the plan with more slots is chosen, also if all areas are 0.
      if (result.cost[slots - 2] >= result.cost[slots - 1]) continue;
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
  /// Area of the root. Costs are divided by it, so that they have the magnitude of counts for scenes of every size.
  double root_area_;
  UnsetVector<Plan> plans_;
};

/// An axis of a node's grid, whose planes lie at origin + byte * 2^(exponent - 127).
struct Axis {
  float origin = 0.0F;
  uint32_t exponent = 1;

  uint32_t byte_below(float plane) const { return static_cast<uint32_t>(steps_to(plane)); }
  uint32_t byte_above(float plane) const {
    const double steps = steps_to(plane);
    const auto whole = static_cast<uint32_t>(steps);
    return whole + (whole < steps ? 1 : 0);
  }
  /// Returns the distance of a plane from the origin in steps. The result is exact, because the step is a power of two.
  /// It is not negative for planes at or above the origin.
  double steps_to(float plane) const {
    const auto inverse_step = std::bit_cast<double>(uint64_t{1023 + 127 - exponent} << 52);
    return (static_cast<double>(plane) - static_cast<double>(origin)) * inverse_step;
  }
};

/// Returns the finest grid that reaches from lo to hi.
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

/// Makes a node with these boxes. The caller sets the children.
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

/// An inner node of the binary tree that must still become a device node.
struct Open {
  uint32_t source = 0;
  uint32_t target = 0;
  /// Largest number of families on the traversal stack when a ray leaves this node: one for each node above it.
  uint32_t stack_entries = 0;
};

/// Makes the device node of `open`, and reserves nodes for its inner children, which are added to `open_children`.
void pack_node(const Bvh& bvh, const Collapse& collapse, const Open& open, PackedTree& tree,
               std::vector<Open>& open_children) {
  const Children children = collapse.children_of(open.source);
  std::array<Bounds, layout::NODE_WIDTH> boxes;
  for (uint32_t i = 0; i < children.count; ++i) boxes[i] = bvh.nodes[children.nodes[i]].bounds;
  Node node = make_node(std::span(boxes).first(children.count));
  tree.stack_size = std::max(tree.stack_size, open.stack_entries);
  for (uint32_t i = 0; i < children.count; ++i) {
    const BvhNode& child = bvh.nodes[children.nodes[i]];
    if (child.count > 0) {
      node.children[static_cast<int>(i)] = leaf_reference(child);
      continue;
    }
    const auto target = static_cast<uint32_t>(tree.nodes.size());
    tree.nodes.emplace_back();
    node.children[static_cast<int>(i)] = target;
    open_children.push_back({children.nodes[i], target, open.stack_entries + 1});
  }
  tree.nodes[open.target] = node;
}

/// Returns the packed nodes below one node, which becomes node 0.
PackedTree pack_subtree(const Bvh& bvh, const Collapse& collapse, Open root) {
  root.target = 0;
  PackedTree tree;
  tree.nodes.emplace_back();
  std::vector<Open> open = {root};
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    pack_node(bvh, collapse, next, tree, open);
  }
  return tree;
}

/// Copies a subtree: its root becomes node `root`, and its other nodes follow from node `first` on.
void place_subtree(PackedTree& subtree, uint32_t root, size_t first, PackedTree& tree) {
  for (Node& node : subtree.nodes) {
    for (int i = 0; i < static_cast<int>(node.frame.w >> 24); ++i) {
      if ((node.children[i] & layout::CHILD_IS_LEAF) == 0) node.children[i] += static_cast<uint32_t>(first) - 1;
    }
  }
  tree.nodes[root] = subtree.nodes.front();
  std::copy(subtree.nodes.begin() + 1, subtree.nodes.end(), tree.nodes.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace

// The top is packed level by level until there are enough subtrees for all threads. The subtrees follow the top in
// their order, so the nodes do not depend on the number of threads.
PackedTree pack_tree(const Bvh& bvh) {
  PackedTree tree;
  tree.nodes.emplace_back();
  tree.nodes[0] = {};
  if (bvh.nodes.empty()) return tree;
  if (bvh.nodes[0].count > 0) {
    // The root must be an inner node, so a single leaf becomes its child.
    tree.nodes[0] = make_node(std::array{bvh.nodes[0].bounds});
    tree.nodes[0].children.x = leaf_reference(bvh.nodes[0]);
    return tree;
  }
  const Collapse collapse(bvh);
  std::vector<Open> open = {Open()};
  while (!open.empty() && open.size() < kSubtrees) {
    std::vector<Open> next_level;
    for (const Open& node : open) pack_node(bvh, collapse, node, tree, next_level);
    open = std::move(next_level);
  }
  std::vector<PackedTree> subtrees(open.size());
  for_each_index(open.size(), 0, [&](size_t i) { subtrees[i] = pack_subtree(bvh, collapse, open[i]); });
  std::vector<size_t> starts = {tree.nodes.size()};
  for (const PackedTree& subtree : subtrees) {
    starts.push_back(starts.back() + subtree.nodes.size() - 1);
    tree.stack_size = std::max(tree.stack_size, subtree.stack_size);
  }
  tree.nodes.resize(starts.back());
  for_each_index(open.size(), 0, [&](size_t i) { place_subtree(subtrees[i], open[i].target, starts[i], tree); });
  return tree;
}

double refit_tree(std::span<Node> nodes, std::span<const uint32_t> references, std::span<const Bounds> boxes) {
  UnsetVector<Bounds> of_nodes;
  of_nodes.resize(nodes.size());
  double cost = 0.0;
  // Children come after their parents.
  for (size_t i = nodes.size(); i-- > 0;) {
    std::array<Bounds, layout::NODE_WIDTH> of_children;
    const uint32_t count = child_count(nodes[i]);
    Bounds all;
    for (uint32_t k = 0; k < count; ++k) {
      const NodeChild child = child_of(nodes[i], k);
      if (child.kind == ChildKind::kNode) {
        of_children[k] = of_nodes[child.first];
      } else {
        for (const uint32_t primitive : references.subspan(child.first, child.count)) {
          of_children[k].extend(boxes[primitive]);
        }
        cost += kTestCost * child.count * of_children[k].half_area();
      }
      all.extend(of_children[k]);
    }
    of_nodes[i] = all;
    if (count == 0) continue;
    const uvec4 children = nodes[i].children;
    nodes[i] = make_node(std::span(of_children).first(count));
    nodes[i].children = children;
    cost += kNodeCost * all.half_area();
  }
  const double area = nodes.empty() || of_nodes[0].is_empty() ? 0.0 : of_nodes[0].half_area();
  return area > 0.0 ? cost / area : cost;
}

}  // namespace promin
