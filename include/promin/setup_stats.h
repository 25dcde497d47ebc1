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

/// Names of the builders of bounding volume hierarchies, the default first.
PROMIN_EXPORT std::span<const std::string_view> builder_names();

/// A bounding volume hierarchy in figures.
struct BvhStats {
  /// Which of builder_names() built it.
  std::string builder;
  /// Nodes of the binary tree, leaves among them.
  uint64_t nodes = 0;
  /// Nodes that hold primitives.
  uint64_t leaves = 0;
  /// Nodes on the longest way from the root to a leaf, both counted; 0 for an empty tree.
  uint32_t depth = 0;
  /// Most primitives in a leaf.
  uint32_t max_leaf_size = 0;
  /// Expected cost of a random ray that meets the root, by the surface area heuristic (Goldsmith & Salmon 1987): a sum
  /// over the inner nodes that it visits and the primitives that it tests.
  double sah_cost = 0.0;
  /// Its size on the device; 0 until it is uploaded.
  uint64_t bytes = 0;
};

/// What setting a scene up on a device cost and made.
struct SetupStats {
  /// Milliseconds of building the tree, or of reading and checking its file.
  double bvh_ms = 0.0;
  /// Milliseconds of copying the scene to the device.
  double upload_ms = 0.0;
  /// Milliseconds of creating pipelines and of their first dispatches, with which drivers compile.
  double pipeline_ms = 0.0;
  /// The tree.
  BvhStats bvh;
  /// Size of the scene in device memory.
  uint64_t device_bytes = 0;
  /// Names for people of the features that the pipeline is specialised to.
  std::vector<std::string> features;
  /// Triangles without area, which are never hit.
  uint64_t degenerate_triangles = 0;
  /// What is shown otherwise than the scene has it, and what would help.
  std::vector<Problem> warnings;
};

/// Counts of what takes long. Their differences tell what a change of the scene took.
struct WorkDone {
  /// Bounding volume hierarchies built; one taken from a file is none.
  uint64_t trees_built = 0;
  /// Bytes of nodes, primitives and surfaces.
  uint64_t geometry_bytes_uploaded = 0;
  /// Bytes of materials and lights.
  uint64_t shading_bytes_uploaded = 0;
  /// Pipelines that the device compiled, for others that use it too.
  uint64_t pipelines_compiled = 0;
};

}  // namespace promin
