// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/find_tree_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "bvh/pack_tree.h"
#include "bvh/read_node.h"
#include "device_scene/pack_scene.h"
#include "gpu/test_scenes.h"
#include "promin/load_scene.h"
#include "support/scene_files.h"

namespace promin {
namespace {

using layout::Node;
using testing::HasSubstr;

world::Scene scene_with(std::vector<world::Object> objects) {
  world::Scene scene;
  scene.materials.resize(1);
  scene.objects = std::move(objects);
  return scene;
}

/// Returns a packed scene with another tree, such as a builder that splits primitives makes.
PackedScene with_tree(const world::Scene& scene, const Bvh& bvh) {
  PackedScene packed = pack_scene(scene, "median");
  std::vector<layout::Primitive> bounded(packed.bounded_count);
  for (size_t slot = 0; slot < packed.references.size(); ++slot) {
    bounded[packed.references[slot]] = packed.primitives[slot];
  }
  PackedTree tree = pack_tree(bvh);
  packed.nodes = std::move(tree.nodes);
  packed.stack_size = tree.stack_size;
  packed.references = bvh.references;
  packed.primitives.clear();
  for (const uint32_t reference : bvh.references) packed.primitives.push_back(bounded[reference]);
  return packed;
}

/// Returns a tree along a chain, in which each leaf has one reference.
Bvh chain_of(std::span<const Bounds> boxes, std::span<const uint32_t> references) {
  Bvh bvh;
  bvh.references.assign(references.begin(), references.end());
  Bounds all;
  for (const Bounds& box : boxes) all.extend(box);
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    if (i + 1 < boxes.size()) bvh.nodes.push_back({all, 2 * i + 1, 0});
    bvh.nodes.push_back({boxes[i], i, 1});
  }
  return bvh;
}

TEST(FindTreeFaults, TreesOfAllBuildersHaveNone) {
  for (const std::filesystem::path& file : scene_files(PROMIN_SCENES_DIR)) {
    const world::Scene scene = world::flatten(load_scene(file));
    for (const std::string_view builder : builder_names()) {
      const TreeFaults faults = find_tree_faults(pack_scene(scene, builder));
      EXPECT_EQ(faults.count, 0U) << file << " " << builder << ": " << faults.first;
    }
  }
}

/// Every plane of every box of a tree is moved inward by a step.
TEST(FindTreeFaults, ShrunkenBoxesAreFound) {
  const PackedScene packed = pack_scene(test::make_scene_of_everything(40), "sah");
  size_t found = 0;
  size_t shrunk = 0;
  for (size_t i = 0; i < packed.nodes.size(); ++i) {
    for (uint32_t child = 0; child < layout::NODE_WIDTH; ++child) {
      if (child_of(packed.nodes[i], child).kind == ChildKind::kAbsent) continue;
      for (int axis = 0; axis < 3; ++axis) {
        for (const bool is_upper : {false, true}) {
          PackedScene spoilt = packed;
          Node& node = spoilt.nodes[i];
          uint32_t& word = !is_upper ? node.lo[axis] : axis == 0 ? node.lo.w : node.hi[axis - 1];
          const uint32_t byte = (word >> (8 * child)) & 0xFF;
          if (byte == (is_upper ? 0U : 255U)) continue;
          word += (is_upper ? -1U : 1U) << (8 * child);
          const TreeFaults faults = find_tree_faults(spoilt);
          ++shrunk;
          found += faults.count > 0 ? 1 : 0;
          if (faults.count > 0) {
            EXPECT_THAT(faults.first, HasSubstr("extends outside the box"));
          }
        }
      }
    }
  }
  // Planes are rounded outward by less than a step.
  EXPECT_GT(shrunk, 300U);
  EXPECT_EQ(found, shrunk);
}

TEST(FindTreeFaults, WhatIsNoBoxHoldsNothing) {
  PackedScene packed = pack_scene(scene_with({{"", world::Sphere{}, 0}}), "sah");
  ASSERT_EQ(find_tree_faults(packed).count, 0U);
  for (const float origin : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    PackedScene spoilt = packed;
    spoilt.nodes[0].frame.y = std::bit_cast<uint32_t>(origin);
    EXPECT_EQ(find_tree_faults(spoilt).count, 1U) << origin;
  }
}

TEST(FindTreeFaults, TheFirstIsNamedWhateverTheThreads) {
  PackedScene packed = pack_scene(test::make_scene_of_everything(30'000), "sah");
  // All boxes shrink to points.
  for (Node& node : packed.nodes) node.frame.w &= 0xFF000000;
  const TreeFaults by_one = find_tree_faults(packed, {.thread_count = 1});
  double told = 0.0;
  const TreeFaults by_many = find_tree_faults(packed, {.thread_count = 5, .progress = [&](double fraction) {
                                                         told = fraction;
                                                         return true;
                                                       }});
  EXPECT_EQ(by_one.count, packed.bounded_count);
  EXPECT_EQ(by_many.count, by_one.count);
  EXPECT_EQ(by_many.first, by_one.first);
  EXPECT_EQ(by_one.first, "primitive 0 of object 1 extends outside the box of its leaf or of a node above it");
  EXPECT_EQ(told, 1.0);
}

TEST(FindTreeFaults, LeavesAreSortedByKind) {
  PackedScene packed = pack_scene(test::make_scene_of_everything(0), "median");
  const auto mixed = [&](const layout::Primitive& a, const layout::Primitive& b) { return a.c.z != b.c.z; };
  const Node& root = packed.nodes[0];
  for (uint32_t i = 0; i < layout::NODE_WIDTH; ++i) {
    const NodeChild child = child_of(root, i);
    if (child.kind != ChildKind::kLeaf || child.count < 2) continue;
    if (!mixed(packed.primitives[child.first], packed.primitives[child.first + 1])) continue;
    std::swap(packed.primitives[child.first], packed.primitives[child.first + 1]);
    std::swap(packed.references[child.first], packed.references[child.first + 1]);
    EXPECT_EQ(find_tree_faults(packed).first, "a leaf of node 0 is not sorted by kind");
    return;
  }
  FAIL() << "no leaf of two kinds";
}

/// A triangle and a sphere beside it; both are in several leaves.
class SplitTree : public testing::Test {
 protected:
  static world::Scene make_scene() {
    Mesh mesh;
    mesh.positions = {vec3(0, 0, 0), vec3(4, 0, 0.5F), vec3(0, 3, 1)};
    mesh.triangles = {{0, 1, 2}};
    return scene_with({{"", mesh, 0}, {"", world::Sphere{vec3(10, 0, 0), 1.0F}, 0}});
  }

  TreeFaults faults() const { return find_tree_faults(with_tree(scene_, chain_of(boxes_, references_))); }

  world::Scene scene_ = make_scene();
  // The triangle is cut at x = 1 and at x = 2.5, and each part has its own bounds; the sphere is cut at y = 0.25.
  std::vector<Bounds> boxes_ = {{vec3(0, 0, 0), vec3(1, 3, 1)},
                                {vec3(1, 0, 0.125F), vec3(2.5F, 2.25F, 0.875F)},
                                {vec3(2.5F, 0, 0.3125F), vec3(4, 1.125F, 0.6875F)},
                                {vec3(8.5F, -1.5F, -1.5F), vec3(11.5F, 0.25F, 1.5F)},
                                {vec3(8.5F, 0.25F, -1.5F), vec3(11.5F, 1.5F, 1.5F)}};
  std::vector<uint32_t> references_ = {0, 0, 0, 1, 1};
};

TEST_F(SplitTree, PartsThatCoverTheWholeAreNoFault) {
  EXPECT_EQ(faults().count, 0U) << faults().first;
}

TEST_F(SplitTree, EveryMissingPartIsFound) {
  for (size_t i = 0; i < boxes_.size(); ++i) {
    const std::vector<Bounds> boxes = boxes_;
    const std::vector<uint32_t> references = references_;
    boxes_.erase(boxes_.begin() + static_cast<std::ptrdiff_t>(i));
    references_.erase(references_.begin() + static_cast<std::ptrdiff_t>(i));
    const TreeFaults found = faults();
    EXPECT_EQ(found.count, 1U) << i;
    EXPECT_THAT(found.first, i < 3
                                 ? HasSubstr("primitive 0 of object 0 is in 2 leaves, and their boxes do not cover it")
                                 : HasSubstr("primitive 0 of object 1 extends outside the box"));
    boxes_ = boxes;
    references_ = references;
  }
}

/// The test makes a gap of a few steps of the grid, on each side of each part that no other part covers.
TEST_F(SplitTree, EveryShrunkenPartIsFound) {
  for (size_t i = 0; i < boxes_.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool is_upper : {false, true}) {
        const std::vector<Bounds> boxes = boxes_;
        // The sphere's boxes are larger than the sphere.
        const float step = i < 3 ? 0.1F : 0.7F;
        if (is_upper) {
          boxes_[i].hi[axis] -= step;
        } else {
          boxes_[i].lo[axis] += step;
        }
        EXPECT_EQ(faults().count, 1U) << "box " << i << ", axis " << axis << (is_upper ? ", hi" : ", lo");
        boxes_ = boxes;
      }
    }
  }
}

TEST_F(SplitTree, BoxesAboveALeafCount) {
  PackedScene packed = with_tree(scene_, chain_of(boxes_, references_));
  ASSERT_EQ(packed.nodes.size(), 2U);
  Node& root = packed.nodes[0];
  uint32_t i = 0;
  while (child_of(root, i).kind != ChildKind::kNode) ASSERT_LT(++i, layout::NODE_WIDTH);
  // This lowers the upper x of the box, so that at least one leaf below extends beyond it.
  root.lo.w -= 0x10U << (8 * i);
  EXPECT_THAT(find_tree_faults(packed).first, HasSubstr("leaves, and their boxes do not cover it"));
}

}  // namespace
}  // namespace promin
