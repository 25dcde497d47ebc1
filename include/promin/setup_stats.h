// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "promin/export.h"

namespace promin {

/// Names of the builders of bounding volume hierarchies, the default first.
PROMIN_EXPORT std::span<const std::string_view> builder_names();

/// A bounding volume hierarchy in figures.
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

/// What setting a scene up on a device cost and made.
struct SetupStats {
  /// Building the tree, or reading and checking its file.
  double bvh_ms = 0.0;
  double upload_ms = 0.0;
  /// Pipeline creation and the first, compiling, dispatch.
  double pipeline_ms = 0.0;
  BvhStats bvh;
  /// Of the scene in device memory.
  uint64_t device_bytes = 0;
  /// Names for people of the features that the pipeline is specialised to.
  std::vector<std::string> features;
  /// Triangles that are never hit.
  uint64_t degenerate_triangles = 0;
};

/// Counts of what takes long: what a change of the scene needed can be told from their differences.
struct WorkDone {
  uint64_t trees_built = 0;
  uint64_t geometry_bytes_uploaded = 0;
  /// Of materials and lights.
  uint64_t shading_bytes_uploaded = 0;
  uint64_t pipelines_compiled = 0;
};

}  // namespace promin
