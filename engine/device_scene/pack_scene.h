// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "bvh/builder.h"
#include "bvh/bvh_file.h"
#include "bvh/find_tree_faults.h"
#include "bvh/primitive_numbers.h"
#include "bvh/tree_view.h"
#include "core/feature_mask.h"
#include "core/unset_vector.h"
#include "layout.h"
#include "scene/world_scene.h"

// What a scene becomes on the device, in the layout of shaders/layout.h: geometry and surfaces together, as both follow
// the order of the tree's leaves; materials and lights each alone, as they change alone. Vulkan-free.
namespace promin {

/// What shading needs of the primitives, in leaf order: material numbers and vertices.
struct PackedSurfaces {
  UnsetVector<layout::SurfaceRecord> surfaces;
  /// Of the vertices that the records number; w is 0. Empty without smooth meshes.
  std::vector<vec4> normals;
  /// Empty without coloured meshes.
  std::vector<vec4> colors;

  uint64_t size_bytes() const;
};

/// Tree, primitives and surfaces, ready to be copied to the device.
struct PackedScene {
  /// At least one; none where a file has them.
  UnsetVector<layout::Node> nodes;
  /// Null where the tree was built.
  std::shared_ptr<const BvhFile> file;
  /// As TreeView::references.
  UnsetVector<uint32_t> references;
  /// Those of the tree in leaf order, then the unbounded ones; at least one.
  UnsetVector<layout::Primitive> primitives;
  uint32_t unbounded_count = 0;
  PackedSurfaces surfaces;
  PrimitiveNumbers numbers;
  /// What the geometry uses.
  FeatureMask features;
  /// Of Scene::materials those that are on something drawn.
  std::vector<bool> shown_materials;
  /// Triangles that are never hit.
  uint64_t degenerate_count = 0;
  /// Center and max-norm radius of all that lies in the tree.
  vec4 tree_bounds{0.0F};
  /// Entries that the traversal stack needs.
  uint32_t stack_size = 1;
  /// What the tree is over: everything but the unbounded and degenerate triangles.
  uint32_t solid_count = 0;
  /// As TreeView has them.
  uint32_t kinds = 0;
  uint64_t geometry_hash = 0;
  BvhStats bvh;
  /// Time of the builder alone, or of reading and checking the file.
  double bvh_ms = 0.0;

  /// The tree, wherever its nodes lie; lives as long as this.
  TreeView tree() const;
  uint32_t first_unbounded() const { return static_cast<uint32_t>(references.size()); }
  /// Primitives by their numbers, triangles in parts counted once, degenerate ones too.
  uint64_t primitive_count() const { return numbers.first_order.empty() ? 0 : numbers.first_order.back(); }
  uint64_t size_bytes() const;
};

/// Packs a checked scene's objects. Throws UsageError for an unknown builder and RunError where counts pass what the
/// layout can hold (2^27 primitives, 2^24 - 1 nodes).
PackedScene pack_scene(const world::Scene& scene, std::string_view builder, const BuildOptions& options = {});

/// Packs a checked scene's objects with the tree of a file. Throws InputError for a file that is bad or not the
/// scene's, and RunError as above.
PackedScene pack_scene_with(const std::filesystem::path& bvh_file, const world::Scene& scene);

/// find_tree_faults of the scene's own tree.
TreeFaults find_tree_faults(const PackedScene& packed, const TreeFaultOptions& options = {});

std::vector<layout::MaterialRecord> pack_materials(std::span<const Material> materials);

/// Those that are on.
struct PackedLights {
  std::vector<layout::LightRecord> records;
  /// Of each record its light's index in Scene::lights.
  std::vector<uint32_t> numbers;
};
PackedLights pack_lights(std::span<const Light> lights);

}  // namespace promin
