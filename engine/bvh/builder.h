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
  /// References in a leaf, 0 in an inner node.
  uint32_t count = 0;
};

/// What a builder makes. Node 0 is the root; a tree of no primitives has no nodes.
struct Bvh {
  UnsetVector<BvhNode> nodes;
  /// Indices of primitives in leaf order, each at least once. A primitive that a builder has split is in several
  /// leaves, whose boxes hold it together.
  UnsetVector<uint32_t> references;
};

/// No builder makes leaves larger, or trees deeper, than this: the device's leaf encoding and its traversal stack
/// rest on it. The median fallback below kMaxBvhDepth - 32 keeps the depth for any count that fits 32 bits.
inline constexpr uint32_t kMaxLeafSize = 16;
inline constexpr uint32_t kMaxBvhDepth = 96;

/// No builder makes more references than this times the primitives.
inline constexpr uint32_t kMaxReferencesPerPrimitive = 2;

/// Units of the SAH: a visit of an inner node, which tests two boxes, against the test of one primitive. Both are some
/// forty operations on 48...64 bytes (two slab tests; a sheared triangle), hence equal weights.
inline constexpr double kNodeCost = 1.0;
inline constexpr double kTestCost = 1.0;

/// What a tree is built over.
struct BuildInput {
  /// The box of each primitive; not empty, finite.
  std::span<const Bounds> boxes;
  /// Gives a box inside `window` that holds every point of the primitive's part in there. The box is empty only where
  /// there is no such point. `window` lies inside the primitive's box. Only builders that split primitives use this;
  /// without it none is split. It must bear calls from several threads.
  std::function<Bounds(uint32_t primitive, const Bounds& window)> clip = {};
};

struct BuildOptions {
  /// 0 takes one thread per core. The tree has the same bits for any number.
  unsigned thread_count = 0;
  ProgressCallback progress = {};
};

/// A tree depends on the input alone; a node comes after its parent. Throws UsageError for an unknown name.
Bvh build_bvh(std::string_view builder, const BuildInput& input, const BuildOptions& options = {});

BvhStats measure_bvh(std::string_view builder, const Bvh& bvh);

}  // namespace promin
