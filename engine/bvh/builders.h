// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bvh/builder.h"

// The builders behind build_bvh, for the table in builder.cpp alone.
namespace promin {

/// The thesis' tree (docs/model.md, "Acceleration"): sort the centroids along the longest axis of the node's box, equal
/// ones by index; split at N/2; stop at two objects. The named baseline that better builders are measured against.
Bvh build_median(std::span<const Bounds> boxes, const BuildOptions& options);

/// Binned surface area heuristic on all three axes (Wald, "On fast Construction of SAH-based Bounding Volume
/// Hierarchies", 2007), on all cores.
Bvh build_sah(std::span<const Bounds> boxes, const BuildOptions& options);

}  // namespace promin
