// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bvh/builder.h"

// The builders that build_bvh() calls. Only the table in builder.cpp uses this header.
namespace promin {

/// The largest depth at which the SAH decides. Deeper ranges are halved by count, regardless of positions: 2^32
/// references that are halved 32 times fit into leaves.
inline constexpr uint32_t kMaxSahDepth = kMaxBvhDepth - 32;

/// The thesis's tree (docs/model.md, "Acceleration"): it sorts the centroids along the longest axis of the node's box,
/// and equal centroids by index; it splits at N/2 and stops at two objects. It is the baseline for comparisons with
/// other builders.
Bvh build_median(const BuildInput& input, const BuildOptions& options);

/// Builds a tree with the binned surface area heuristic on all three axes (Wald, "On fast Construction of SAH-based
/// Bounding Volume Hierarchies", 2007). Uses all cores.
Bvh build_sah(const BuildInput& input, const BuildOptions& options);

/// Builds a tree with the surface area heuristic and spatial splits (Stich, Friedrich, Dietrich, "Spatial Splits in
/// Bounding Volume Hierarchies", HPG 2009). A plane may also cut primitives in two, and each part then has its own box.
/// The number of references that cutting may add is distributed from the root downwards, in proportion to counts
/// (Fuetterling et al., "Parallel Spatial Splits in Bounding Volume Hierarchies", EGPGV 2016), so that subtrees do not
/// depend on each other. If build_sah's tree costs less, the result is that tree. Uses all cores.
Bvh build_spatial(const BuildInput& input, const BuildOptions& options);

}  // namespace promin
