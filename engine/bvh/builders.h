// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bvh/builder.h"

// The builders behind build_bvh, only for the table in builder.cpp.
namespace promin {

/// Deeper ranges are halved by count, regardless of positions: 2^32 references halved 32 times fit into leaves.
inline constexpr uint32_t kMaxSahDepth = kMaxBvhDepth - 32;

/// The thesis's tree (docs/model.md, "Acceleration"): sort the centroids along the longest axis of the node's box,
/// equal ones by index; split at N/2; stop at two objects. It is the baseline for comparisons with other builders.
Bvh build_median(const BuildInput& input, const BuildOptions& options);

/// Binned surface area heuristic on all three axes (Wald, "On fast Construction of SAH-based Bounding Volume
/// Hierarchies", 2007), on all cores.
Bvh build_sah(const BuildInput& input, const BuildOptions& options);

/// The surface area heuristic with spatial splits (Stich, Friedrich, Dietrich, "Spatial Splits in Bounding Volume
/// Hierarchies", HPG 2009): a plane may also cut primitives in two, and each part gets its own box. The budget of
/// references that cutting may add is distributed from the root down, by count (Fuetterling et al., "Parallel Spatial
/// Splits in Bounding Volume Hierarchies", EGPGV 2016), so that subtrees do not depend on each other. If build_sah's
/// tree costs less, the result is that tree. Uses all cores.
Bvh build_spatial(const BuildInput& input, const BuildOptions& options);

}  // namespace promin
