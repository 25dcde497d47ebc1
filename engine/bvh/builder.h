// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/unset_vector.h"
#include "promin/math.h"
#include "promin/progress.h"
#include "promin/setup_stats.h"

namespace promin {

/// One box of a binary tree. The children of an inner node are `first` and `first + 1`; a leaf holds the references
/// [first, first + count) of Bvh::references.
struct BvhNode {
  Bounds bounds;
  uint32_t first = 0;
  /// Number of references in a leaf; 0 in an inner node.
  uint32_t count = 0;
};

/// The result of a builder. Node 0 is the root; a tree without primitives has no nodes.
struct Bvh {
  UnsetVector<BvhNode> nodes;
  /// Indices of primitives in leaf order, each at least once. A primitive that a builder has split is in several
  /// leaves, whose boxes together contain it.
  UnsetVector<uint32_t> references;
};

/// Limits of all builders. The device's encoding of leaves and its traversal stack depend on them. The median fallback
/// below kMaxBvhDepth - 32 keeps the depth within the limit for every count that fits into 32 bits.
inline constexpr uint32_t kMaxLeafSize = 16;
inline constexpr uint32_t kMaxBvhDepth = 96;

/// The largest number of references per primitive that any builder makes.
inline constexpr uint32_t kMaxReferencesPerPrimitive = 2;

/// Units of the SAH: the cost of visiting an inner node, which tests two boxes, and the cost of testing one primitive.
/// Both tests take about forty operations on 48...64 bytes (two slab tests; a sheared triangle), so the costs are
/// equal.
inline constexpr double kNodeCost = 1.0;
inline constexpr double kTestCost = 1.0;

/// The input of a builder.
struct BuildInput {
  /// The box of each primitive; finite and not empty.
  std::span<const Bounds> boxes;
  /// Returns a box inside `window` that contains every point of the primitive inside `window`. The returned box is
  /// empty only if there is no such point. `window` lies inside the primitive's box. Only builders that split
  /// primitives use this function; without it they split no primitive. Several threads may call it.
  std::function<Bounds(uint32_t primitive, const Bounds& window)> clip = {};
};

struct BuildOptions {
  /// Number of threads; 0 uses one thread per core. The tree has the same bits for every number.
  unsigned thread_count = 0;
  ProgressCallback progress = {};
};

/// Builds a tree that depends only on the input. A node comes after its parent. Throws UsageError if no builder has
/// this name.
Bvh build_bvh(std::string_view builder, const BuildInput& input, const BuildOptions& options = {});

BvhStats measure_bvh(std::string_view builder, const Bvh& bvh);

}  // namespace promin
