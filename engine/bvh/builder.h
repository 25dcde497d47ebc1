// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "core/shared_progress.h"

namespace promin {

/// One box of a binary tree. The children of an inner node are `first` and `first + 1`; a leaf holds the references
/// [first, first + count) of Bvh::references.
struct BvhNode {
  Bounds bounds;
  uint32_t first = 0;
  /// References in a leaf, 0 in an inner node.
  uint32_t count = 0;
};

/// What a builder makes. Node 0 is the root; a tree of no primitives has no nodes.
struct Bvh {
  std::vector<BvhNode> nodes;
  /// Indices into the span of bounds that the builder was given, in leaf order.
  std::vector<uint32_t> references;
};

struct BvhStats {
  std::string builder;
  uint64_t nodes = 0;
  uint64_t leaves = 0;
  /// Nodes on the longest way from the root to a leaf, both counted; 0 for an empty tree.
  uint32_t depth = 0;
  uint32_t max_leaf_size = 0;
  /// Expected cost of a random ray that meets the root: kNodeCost for each inner node visited and kTestCost for each
  /// primitive tested (Goldsmith & Salmon 1987).
  double sah_cost = 0.0;
  /// On the device; 0 until it is uploaded.
  uint64_t bytes = 0;
};

/// No builder makes leaves larger, or trees deeper, than this: the device's leaf encoding and its traversal stack
/// rest on it. The median fallback below kMaxBvhDepth - 32 keeps the depth for any count that fits 32 bits.
inline constexpr uint32_t kMaxLeafSize = 16;
inline constexpr uint32_t kMaxBvhDepth = 96;

/// Units of the SAH: a visit of an inner node, which tests two boxes, against the test of one primitive. Both are some
/// forty operations on 48...64 bytes (two slab tests; a sheared triangle), hence equal weights.
inline constexpr double kNodeCost = 1.0;
inline constexpr double kTestCost = 1.0;

struct BuildOptions {
  /// 0: one per core. The tree is the same, to the bit, for any number.
  unsigned thread_count = 0;
  /// Called by any of the build's threads, one call at a time.
  ProgressCallback progress = {};
};

/// Names of the builders, the default first.
std::span<const std::string_view> builder_names();

/// Builds a tree over boxes that are not empty and finite. The tree depends on the boxes alone; a node comes after its
/// parent. Throws UsageError for an unknown name.
Bvh build_bvh(std::string_view builder, std::span<const Bounds> boxes, const BuildOptions& options = {});

BvhStats measure_bvh(std::string_view builder, const Bvh& bvh);

}  // namespace promin
