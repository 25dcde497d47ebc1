// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "bvh/builder.h"

namespace promin::test {

inline bool contains(const Bounds& outer, const Bounds& inner) {
  return glm::all(glm::lessThanEqual(outer.lo, inner.lo)) && glm::all(glm::greaterThanEqual(outer.hi, inner.hi));
}

/// Expects a valid tree. Each node except the root is one node's child, inside it and after it. Each reference is in
/// one leaf. Leaves and depth keep their bounds, and no leaf has a primitive twice.
inline void expect_tree(const Bvh& bvh) {
  std::vector<int> node_uses(bvh.nodes.size(), 0);
  std::vector<int> reference_uses(bvh.references.size(), 0);
  node_uses.at(0) += 1;
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    if (node.count == 0) {
      ASSERT_GT(node.first, i);
      for (uint32_t child = node.first; child < node.first + 2; ++child) {
        node_uses.at(child) += 1;
        ASSERT_TRUE(contains(node.bounds, bvh.nodes[child].bounds)) << i << " around " << child;
      }
    }
    ASSERT_LE(node.count, kMaxLeafSize);
    for (uint32_t k = node.first; node.count > 0 && k < node.first + node.count; ++k) {
      reference_uses.at(k) += 1;
      ASSERT_EQ(std::count(&bvh.references[node.first], &bvh.references[k], bvh.references[k]), 0) << "twice in a leaf";
    }
  }
  EXPECT_EQ(std::count(node_uses.begin(), node_uses.end(), 1), std::ssize(node_uses));
  EXPECT_EQ(std::count(reference_uses.begin(), reference_uses.end(), 1), std::ssize(reference_uses));
  EXPECT_LE(measure_bvh("any", bvh).depth, kMaxBvhDepth);
}

}  // namespace promin::test
