// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "render/pack_scene.h"
#include "render/read_node.h"

namespace promin {
namespace {

using layout::Node;

std::vector<Bounds> random_boxes(size_t count, double spread, double size, uint32_t seed) {
  std::mt19937 generator(seed);
  const auto uniform = [&] { return static_cast<double>(generator()) * 0x1p-32; };
  std::vector<Bounds> boxes(count);
  for (Bounds& box : boxes) {
    const dvec3 center = spread * (2.0 * dvec3(uniform(), uniform(), uniform()) - 1.0);
    // Some are flat.
    const dvec3 half = size * dvec3(uniform(), generator() % 4 == 0 ? 0.0 : uniform(), uniform());
    box.lo = vec3(center - half);
    box.hi = vec3(center + half);
  }
  return boxes;
}

/// Walks the device's tree and checks what a traversal relies on.
class Walk {
 public:
  Walk(const PackedTree& tree, const Bvh& bvh, std::span<const Bounds> boxes)
      : tree_(tree), bvh_(bvh), boxes_(boxes), seen_(boxes.size(), 0) {
    visit(0, 0);
  }

  void expect_whole() const {
    EXPECT_EQ(std::count(seen_.begin(), seen_.end(), 1), static_cast<std::ptrdiff_t>(seen_.size()))
        << "each primitive in one leaf";
    EXPECT_EQ(visited_, tree_.nodes.size());
    EXPECT_EQ(std::max(most_entries_, 1U), tree_.stack_size) << "no more and no less stack than it takes";
  }

 private:
  /// Returns the bounds of all primitives below. `entries`: families on the stack when a ray leaves the node, one for
  /// each node above.
  Bounds visit(uint32_t index, uint32_t entries) {
    ++visited_;
    const Node& node = tree_.nodes.at(index);
    const uint32_t count = child_count(node);
    EXPECT_LE(count, layout::NODE_WIDTH);
    most_entries_ = std::max(most_entries_, entries);
    Bounds all;
    for (uint32_t i = 0; i < count; ++i) {
      const NodeChild child = child_of(node, i);
      const Bounds held = child.kind == ChildKind::kLeaf ? visit_leaf(child) : visit(child.first, entries + 1);
      const Box box = child_box(node, i);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(box.lo[axis], static_cast<double>(held.lo[axis])) << "node " << index << ", child " << i;
        EXPECT_GE(box.hi[axis], static_cast<double>(held.hi[axis])) << "node " << index << ", child " << i;
      }
      all.extend(held);
    }
    return all;
  }

  Bounds visit_leaf(const NodeChild& leaf) {
    Bounds all;
    for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      ++seen_.at(bvh_.references.at(i));
      all.extend(boxes_[bvh_.references[i]]);
    }
    return all;
  }

  const PackedTree& tree_;
  const Bvh& bvh_;
  std::span<const Bounds> boxes_;
  std::vector<int> seen_;
  size_t visited_ = 0;
  uint32_t most_entries_ = 0;
};

TEST(PackTree, EveryBoxHoldsWhatIsBelowIt) {
  for (const std::string_view builder : builder_names()) {
    for (const size_t count : {1U, 2U, 3U, 17U, 1000U}) {
      for (const auto& [spread, size] : {std::pair(1.0, 0.1), std::pair(1e6, 1e-3), std::pair(1e15, 1e14),
                                         std::pair(1e-18, 1e-20), std::pair(0.0, 1.0), std::pair(1.0, 0.0)}) {
        const std::vector<Bounds> boxes = random_boxes(count, spread, size, static_cast<uint32_t>(count));
        const Bvh bvh = build_bvh(builder, boxes);
        const PackedTree tree = pack_tree(bvh);
        SCOPED_TRACE(std::string(builder) + ", boxes " + std::to_string(count) + ", spread " + std::to_string(spread));
        Walk(tree, bvh, boxes).expect_whole();
      }
    }
  }
}

TEST(PackTree, NodesAreFilled) {
  const std::vector<Bounds> boxes = random_boxes(4000, 1.0, 0.01, 7);
  const Bvh bvh = build_bvh("sah", boxes);
  const PackedTree tree = pack_tree(bvh);
  const auto leaves = static_cast<size_t>(
      std::count_if(bvh.nodes.begin(), bvh.nodes.end(), [](const BvhNode& node) { return node.count > 0; }));
  // Full nodes would take a third of the leaves.
  EXPECT_LT(tree.nodes.size(), leaves / 2);
}

TEST(PackTree, NoPrimitivesAreANodeWithoutChildren) {
  const PackedTree tree = pack_tree(Bvh());
  ASSERT_EQ(tree.nodes.size(), 1U);
  EXPECT_EQ(child_count(tree.nodes[0]), 0U);
}

}  // namespace
}  // namespace promin
