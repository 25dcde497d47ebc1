// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "promin/error.h"
#include "promin/export.h"

namespace promin {

/// Returns the names of the builders of bounding volume hierarchies. The first name is the default.
PROMIN_EXPORT std::span<const std::string_view> builder_names();

/// Statistics of a bounding volume hierarchy.
struct BvhStats {
  /// The name of the builder, one of builder_names().
  std::string builder;
  /// Number of nodes of the binary tree, including leaves.
  uint64_t nodes = 0;
  /// Number of leaves.
  uint64_t leaves = 0;
  /// Number of nodes on the longest path from the root to a leaf, including both; 0 for an empty tree.
  uint32_t depth = 0;
  /// The largest number of primitives in a leaf.
  uint32_t max_leaf_size = 0;
  /// Expected cost of a random ray that hits the root, by the surface area heuristic (Goldsmith & Salmon 1987): a
  /// weighted sum of the inner nodes that it visits and the primitives that it tests.
  double sah_cost = 0.0;
  /// Size of the tree on the device in bytes; 0 before the tree is uploaded.
  uint64_t bytes = 0;
};

/// Cost and results of setting up a scene on a device.
struct SetupStats {
  /// Time for building the tree, or for reading and checking its file, in milliseconds.
  double bvh_ms = 0.0;
  /// Time for copying the scene to the device, in milliseconds.
  double upload_ms = 0.0;
  /// Time for creating pipelines and for their first dispatches, in milliseconds. Drivers compile during the first
  /// dispatch.
  double pipeline_ms = 0.0;
  /// Statistics of the tree.
  BvhStats bvh;
  /// Size of the scene in device memory, in bytes.
  uint64_t device_bytes = 0;
  /// Display names of the features that the pipeline is specialised for.
  std::vector<std::string> features;
  /// Number of triangles without area. No ray hits them.
  uint64_t degenerate_triangles = 0;
  /// Parts of the scene that promin shows differently than the scene describes, each with a way to avoid this.
  std::vector<Problem> warnings;
};

/// Counts of expensive work. Differences of two counts show the cost of a change of the scene.
struct WorkDone {
  /// Number of trees that were built. Trees read from a file do not count.
  uint64_t trees_built = 0;
  /// Number of bytes of nodes, primitives and surfaces that were uploaded.
  uint64_t geometry_bytes_uploaded = 0;
  /// Number of bytes of the tree's upper level and of instances that were uploaded because instances have moved.
  uint64_t move_bytes_uploaded = 0;
  /// Number of bytes of materials and lights that were uploaded.
  uint64_t shading_bytes_uploaded = 0;
  /// Number of pipelines that the device compiled, including pipelines for other users of the device.
  uint64_t pipelines_compiled = 0;
};

}  // namespace promin
