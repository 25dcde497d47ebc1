// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "bvh/builder.h"
#include "bvh/bvh_file.h"
#include "bvh/tree_view.h"
#include "core/unset_vector.h"
#include "device_scene/collect_primitives.h"
#include "shared/layout.h"

namespace promin {

/// The tree of a geometry: of the primitives of a scene without its instances, or of a mesh that instances share.
struct GeometryTree {
  UnsetVector<layout::Node> nodes;
  /// The references in leaf order, sorted by kind within each leaf.
  UnsetVector<uint32_t> references;
  uint32_t primitive_count = 0;
  uint32_t stack_size = 1;
  uint32_t kinds = 0;
  /// The hash_geometry() of the primitives; 0 if nobody has set it.
  uint64_t geometry_hash = 0;
  BvhStats stats;
  /// The binary tree with the same leaves; empty for a mesh after keep_top_boxes().
  Bvh binary;
  /// Boxes that together contain a mesh (PackedMesh::top_boxes).
  std::vector<Bounds> top_boxes;

  TreeView view() const;
};

/// Returns the kinds of the primitives, as bits 1 << KIND_*.
uint32_t kinds_of(const Collected& collected);

/// Returns a hash of the geometry. It does not depend on the assignment of primitives to objects.
uint64_t hash_geometry(const Collected& collected);

/// Builds a tree over primitives of a scene, without the hash of the geometry. Throws UsageError for an unknown
/// builder, and RunError if there are more references or nodes than the layout can hold.
GeometryTree build_geometry_tree(const Collected& collected, const world::Scene& scene, std::string_view builder,
                                 const BuildOptions& options);

/// Returns the tree of these primitives from a file. Throws InputError if the file does not have it.
GeometryTree read_geometry_tree(const Collected& collected, const BvhFile& file);

}  // namespace promin
