// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"

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
  uint32_t depth = 0;
  uint32_t max_leaf_size = 0;
  /// Expected cost of a random ray that meets the root: node visits + primitive tests (Goldsmith & Salmon 1987).
  double sah_cost = 0.0;
  /// On the device.
  uint64_t bytes = 0;
};

/// No builder makes leaves larger, or trees deeper, than this: the device's leaf encoding and its traversal stack
/// rest on it. The median fallback below kMaxBvhDepth - 32 keeps the depth for any count that fits 32 bits.
inline constexpr uint32_t kMaxLeafSize = 16;
inline constexpr uint32_t kMaxBvhDepth = 96;

/// Names of the builders, the default first.
std::span<const std::string_view> builder_names();

/// Builds a tree over boxes that are not empty and finite. The tree depends on the boxes alone.
/// Throws UsageError for an unknown name.
Bvh build_bvh(std::string_view builder, std::span<const Bounds> boxes);

BvhStats measure_bvh(std::string_view builder, const Bvh& bvh);

}  // namespace promin
