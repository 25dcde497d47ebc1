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
#include "device_scene/collect_primitives.h"
#include "device_scene/drop_copies.h"
#include "layout.h"
#include "promin/error.h"
#include "scene/world_scene.h"
#include "textures/pack_images.h"

// What a scene's geometry becomes on the device, in the layout of shaders/layout.h, with its surfaces, as both follow
// the order of the tree's leaves. Vulkan-free.
namespace promin {

/// What shading needs of the primitives, in leaf order: material numbers and vertices.
struct PackedSurfaces {
  UnsetVector<layout::SurfaceRecord> surfaces;
  /// Of the vertices that the records number.
  VertexRecords vertices;
  PackedImages images;

  uint64_t size_bytes() const;
};

/// Tree, primitives and surfaces, ready to be copied to the device.
struct PackedScene {
  /// At least one node; empty where a file has the nodes.
  UnsetVector<layout::Node> nodes;
  /// Null where the tree was built.
  std::shared_ptr<const BvhFile> file;
  /// See TreeView::references.
  UnsetVector<uint32_t> references;
  /// The primitives of the tree in leaf order, then the unbounded ones; at least one.
  UnsetVector<layout::Primitive> primitives;
  uint32_t unbounded_count = 0;
  PackedSurfaces surfaces;
  PrimitiveNumbers numbers;
  /// Primitives that are neither in the tree nor among its primitives, as they are copies of one that is.
  DroppedCopies copies;
  /// The features that the geometry uses.
  FeatureMask features;
  /// Whether each of Scene::materials is on something that is drawn.
  std::vector<bool> shown_materials;
  /// The number of triangles that are never hit.
  uint64_t degenerate_count = 0;
  /// Center and max-norm radius of all that lies in the tree.
  vec4 tree_bounds{0.0F};
  /// Entries that the traversal stack needs.
  uint32_t stack_size = 1;
  /// The number of primitives that the tree is built over: all but the unbounded ones, copies and degenerate
  /// triangles.
  uint32_t bounded_count = 0;
  /// How many of these are no triangles.
  uint32_t solid_count = 0;
  /// See TreeView::kinds.
  uint32_t kinds = 0;
  uint64_t geometry_hash = 0;
  BvhStats bvh;
  /// Time of the builder alone, or of reading and checking the file; of a shared tree that was built here all of it,
  /// with waiting and writing.
  double bvh_ms = 0.0;
  /// Of pack_scene_sharing: what was wrong with the file.
  std::vector<Problem> warnings;

  /// The tree, whether its nodes lie here or in the file. It lives as long as this.
  TreeView tree() const;
  uint32_t first_unbounded() const { return static_cast<uint32_t>(references.size()); }
  /// The number of primitives: triangles in parts count once, degenerate ones too.
  uint64_t primitive_count() const { return numbers.first_order.empty() ? 0 : numbers.first_order.back(); }
  uint64_t size_bytes() const;
};

/// Packs a checked scene's objects. Throws UsageError for an unknown builder and RunError where counts pass what the
/// layout can hold (2^27 primitives, 2^24 - 1 nodes), and as pack_images does for images in `texture_bytes`.
PackedScene pack_scene(const world::Scene& scene, std::string_view builder, const BuildOptions& options = {},
                       uint64_t texture_bytes = kDefaultTextureBytes);

/// Packs a checked scene's objects with the tree of a file. Throws InputError for a file that is bad or not the
/// scene's, and RunError as above.
PackedScene pack_scene_with(const std::filesystem::path& bvh_file, const world::Scene& scene,
                            uint64_t texture_bytes = kDefaultTextureBytes);

/// From so many primitives on a shared tree is kept in its file: the default builder makes smaller ones in a few
/// milliseconds (docs/jobs.md has figures), and a folder that machines share may take as long for a file.
inline constexpr size_t kLeastShared = 100'000;

/// Packs a checked scene's objects with a tree that all who work on the scene have in common: that of the file, of the
/// scene and the builder, which one of them builds and writes while others who ask for it wait. Where the file is
/// damaged or of another scene, the same; where it cannot be written everyone builds, and warnings tell. Trees of fewer
/// primitives than kLeastShared are built and have no file. The file's folder is made where it is not there. Throws
/// what pack_scene does, and Cancelled as the options' progress says, while it waits too.
PackedScene pack_scene_sharing(const std::filesystem::path& bvh_file, const world::Scene& scene,
                               std::string_view builder, const BuildOptions& options = {},
                               uint64_t texture_bytes = kDefaultTextureBytes);

/// Packs with the tree that the options of a Renderer or a Caster ask for.
template <typename Options>
PackedScene pack_scene_by(const Options& options, const world::Scene& scene,
                          uint64_t texture_bytes = kDefaultTextureBytes) {
  if (options.bvh) return pack_scene_with(*options.bvh, scene, texture_bytes);
  const BuildOptions how = {.progress = options.progress};
  if (!options.shared_bvh) return pack_scene(scene, options.builder, how, texture_bytes);
  return pack_scene_sharing(*options.shared_bvh, scene, options.builder, how, texture_bytes);
}

/// Applies find_tree_faults to the scene's own tree.
TreeFaults find_tree_faults(const PackedScene& packed, const TreeFaultOptions& options = {});

}  // namespace promin
