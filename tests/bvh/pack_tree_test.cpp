// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <random>

#include "bvh/pack_tree.h"
#include "bvh/read_node.h"
#include "device_scene/pack_scene.h"

namespace promin {
namespace {

using layout::Node;
uint32_t byte_of(uint32_t word, uint32_t index) {
  return (word >> (8 * index)) & 0xFF;
}

/// Expects that fp32 rounds each plane of a child's box only once, with and without a fused multiply-add. This holds
/// because steps are powers of two.
void expect_contraction_is_no_matter(const Node& node, uint32_t child) {
  const ExactBounds box = child_box(node, child);
  const uvec3 hi_words(node.lo.w, node.hi.x, node.hi.y);
  for (int axis = 0; axis < 3; ++axis) {
    const auto origin = std::bit_cast<float>(node.frame[axis]);
    const auto step = std::bit_cast<float>(byte_of(node.frame.w, static_cast<uint32_t>(axis)) << 23);
    const auto expect_plane = [&](uint32_t byte, double exact) {
      const auto factor = static_cast<float>(byte);
      const float product = step * factor;
      EXPECT_EQ(product + origin, std::fma(step, factor, origin));
      EXPECT_EQ(product + origin, static_cast<float>(exact));
    };
    expect_plane(byte_of(node.lo[axis], child), box.lo[axis]);
    expect_plane(byte_of(hi_words[axis], child), box.hi[axis]);
  }
}

std::vector<Bounds> random_boxes(size_t count, double spread, double size, uint32_t seed) {
  std::mt19937 generator(seed);
  const auto uniform = [&] { return static_cast<double>(generator()) * 0x1p-32; };
  std::vector<Bounds> boxes(count);
  for (Bounds& box : boxes) {
    const dvec3 center = spread * (2.0 * dvec3(uniform(), uniform(), uniform()) - 1.0);
    // Some boxes are flat.
    const dvec3 half = size * dvec3(uniform(), generator() % 4 == 0 ? 0.0 : uniform(), uniform());
    box.lo = vec3(center - half);
    box.hi = vec3(center + half);
  }
  return boxes;
}

/// Walks the device's tree and checks the properties on which a traversal relies.
class Walk {
 public:
  Walk(const PackedTree& tree, const Bvh& bvh, size_t primitive_count)
      : tree_(tree), bvh_(bvh), seen_(primitive_count, 0) {
    for (const BvhNode& node : bvh.nodes) {
      if (node.count > 0) leaves_[node.first] = node;
    }
    visit(0, 0);
  }

  void expect_whole() const {
    EXPECT_EQ(std::count(seen_.begin(), seen_.end(), 0), 0) << "each primitive in some leaf";
    EXPECT_EQ(std::accumulate(seen_.begin(), seen_.end(), size_t{0}), bvh_.references.size());
    EXPECT_EQ(visited_, tree_.nodes.size());
    EXPECT_EQ(std::max(most_entries_, 1U), tree_.stack_size) << "no more and no less stack than it takes";
  }

 private:
  /// Returns the bounds of all leaves below. `entries` is the number of families on the stack when a ray leaves the
  /// node, one for each node above it.
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
      const ExactBounds box = child_box(node, i);
      expect_contraction_is_no_matter(node, i);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(box.lo[axis], static_cast<double>(held.lo[axis])) << "node " << index << ", child " << i;
        EXPECT_GE(box.hi[axis], static_cast<double>(held.hi[axis])) << "node " << index << ", child " << i;
      }
      all.extend(held);
    }
    return all;
  }

  Bounds visit_leaf(const NodeChild& child) {
    const BvhNode& leaf = leaves_.at(child.first);
    EXPECT_EQ(leaf.count, child.count);
    for (uint32_t i = child.first; i < child.first + child.count; ++i) ++seen_.at(bvh_.references.at(i));
    return leaf.bounds;
  }

  const PackedTree& tree_;
  const Bvh& bvh_;
  /// The leaves by their first reference. The builder, not the packing, must make sure that a leaf's box holds its
  /// primitives.
  std::map<uint32_t, BvhNode> leaves_;
  std::vector<size_t> seen_;
  size_t visited_ = 0;
  uint32_t most_entries_ = 0;
};

TEST(PackTree, EveryBoxHoldsWhatIsBelowIt) {
  for (const std::string_view builder : builder_names()) {
    for (const size_t count : {1U, 2U, 3U, 17U, 1000U}) {
      for (const auto& [spread, size] : {std::pair(1.0, 0.1), std::pair(1e6, 1e-3), std::pair(1e15, 1e14),
                                         std::pair(1e-18, 1e-20), std::pair(0.0, 1.0), std::pair(1.0, 0.0)}) {
        const std::vector<Bounds> boxes = random_boxes(count, spread, size, static_cast<uint32_t>(count));
        const Bvh bvh = build_bvh(builder, {boxes, [](uint32_t, const Bounds& window) { return window; }});
        const PackedTree tree = pack_tree(bvh);
        SCOPED_TRACE(std::string(builder) + ", boxes " + std::to_string(count) + ", spread " + std::to_string(spread));
        Walk(tree, bvh, boxes.size()).expect_whole();
      }
    }
  }
}

class PackTreeFilled : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(PackTreeFilled, NodesAreFilled) {
  const auto& [spread, size] = GetParam();
  const std::vector<Bounds> boxes = random_boxes(4000, spread, size, 7);
  const Bvh bvh = build_bvh("sah", {boxes});
  const PackedTree tree = pack_tree(bvh);
  const auto leaves = static_cast<size_t>(
      std::count_if(bvh.nodes.begin(), bvh.nodes.end(), [](const BvhNode& node) { return node.count > 0; }));
  // With full nodes, there would be a third as many nodes as leaves.
  EXPECT_LT(tree.nodes.size(), leaves / 2);
}

// Some sizes give areas that fp32 cannot hold, and some give only areas of 0.
INSTANTIATE_TEST_SUITE_P(Sizes, PackTreeFilled,
                         testing::Values(std::pair(1.0, 0.01), std::pair(1e25, 1e23), std::pair(1e-25, 1e-27),
                                         std::pair(1.0, 0.0)));

TEST(PackTree, NoPrimitivesAreANodeWithoutChildren) {
  const PackedTree tree = pack_tree(Bvh());
  ASSERT_EQ(tree.nodes.size(), 1U);
  EXPECT_EQ(child_count(tree.nodes[0]), 0U);
}

TEST(RefitTreeTest, BoxesContainMovedPrimitives) {
  std::vector<Bounds> boxes = random_boxes(3000, 10.0, 0.2, 5);
  Bvh bvh = build_bvh("sah", {boxes});
  PackedTree tree = pack_tree(bvh);
  const UnsetVector<Node> before = tree.nodes;
  const double cost = refit_tree(tree.nodes, bvh.references, boxes);
  EXPECT_EQ(std::memcmp(tree.nodes.data(), before.data(), before.size() * sizeof(Node)), 0)
      << "unmoved primitives keep all boxes";

  std::mt19937 generator(6);
  for (Bounds& box : boxes) {
    const vec3 step(0.01F * static_cast<float>(generator() % 100), 0.0F, -5.0F);
    box = {box.lo + step, box.hi + step};
  }
  EXPECT_GT(refit_tree(tree.nodes, bvh.references, boxes), cost) << "the primitives have moved apart";
  for (BvhNode& node : bvh.nodes) {
    if (node.count == 0) continue;
    node.bounds = {};
    for (uint32_t i = node.first; i < node.first + node.count; ++i) node.bounds.extend(boxes[bvh.references[i]]);
  }
  Walk(tree, bvh, boxes.size()).expect_whole();
}

TEST(RefitTreeTest, TreesWithoutInnerNodes) {
  for (const size_t count : {0, 1, 2}) {
    const std::vector<Bounds> boxes = random_boxes(count, 1.0, 0.5, 2);
    const Bvh bvh = build_bvh("sah", {boxes});
    PackedTree tree = pack_tree(bvh);
    const UnsetVector<Node> before = tree.nodes;
    refit_tree(tree.nodes, bvh.references, boxes);
    EXPECT_EQ(std::memcmp(tree.nodes.data(), before.data(), before.size() * sizeof(Node)), 0);
  }
}

}  // namespace
}  // namespace promin
