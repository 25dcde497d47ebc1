// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bvh/builder.h"
#include "bvh/primitive_numbers.h"
#include "core/unset_vector.h"
#include "device_scene/collect_primitives.h"
#include "promin/math.h"
#include "scene/world_scene.h"
#include "shared/layout.h"

// A tree of two levels. The nodes of the upper level come first. Their leaves are leaves of the scene's own primitives,
// and instances. Then follow the nodes of each mesh that instances share, and the records of the instances (layout.h).
// The references of the scene's own primitives come before those of the meshes.
namespace promin {

/// A mesh that instances share, with its tree.
struct PackedMesh {
  UnsetVector<layout::Node> nodes;
  uint32_t stack_size = 1;
  /// The primitives and surfaces in leaf order. Their numbers begin at 0.
  UnsetVector<layout::Primitive> primitives;
  UnsetVector<layout::SurfaceRecord> surfaces;
  VertexRecords vertices;
  std::vector<PackedPart> parts;
  /// The number of numbers that the mesh takes: one for each part of a triangle.
  uint32_t number_count = 0;
  /// The number of primitives, without degenerate triangles. A builder may refer to one several times.
  uint32_t bounded_count = 0;
  uint64_t degenerate_count = 0;
  /// The bounds of all primitives.
  Bounds box;
  /// Boxes that together contain the mesh, for the box of an instance. They are empty if no ray can hit the mesh.
  std::vector<Bounds> top_boxes;
  BvhStats bvh;
};

/// Packs a mesh. `scene` has only this mesh, as its only object.
PackedMesh pack_mesh(const world::Scene& scene, std::string_view builder, const BuildOptions& options);

/// The input of build_two_levels.
struct TwoLevels {
  const world::Scene& scene;
  /// The tree of the scene's own primitives, which may be empty.
  const Bvh& own;
  /// The number of references of `own`.
  uint32_t own_reference_count = 0;
  /// The meshes of the scene, in order.
  std::span<const PackedMesh> meshes;
  /// The number of the first primitive of each object.
  std::span<const uint32_t> first_order;
};

/// The nodes of both levels with the records of instances.
struct TwoLevelTree {
  UnsetVector<layout::Node> nodes;
  uint32_t stack_size = 1;
  /// The number of nodes without the records.
  uint32_t node_count = 0;
  uint64_t instance_count = 0;
  /// Bounds of all instances, not the smallest ones.
  Bounds bounds;
  /// The depth and the cost of the upper level.
  BvhStats upper;
};
TwoLevelTree build_two_levels(const TwoLevels& input, const BuildOptions& options);

}  // namespace promin
