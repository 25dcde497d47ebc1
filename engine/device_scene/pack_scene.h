// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
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
#include "device_scene/geometry_tree.h"
#include "promin/error.h"
#include "scene/world_scene.h"
#include "shared/layout.h"
#include "textures/pack_images.h"

// Packs a scene's geometry and surfaces into the device layout of shaders/shared/layout.h. Both are stored in the order
// of the tree's leaves. This code does not use Vulkan.
namespace promin {

class UpperLevel;

/// Data of primitives that shading needs, in leaf order: material numbers and vertices.
struct PackedSurfaces {
  UnsetVector<layout::SurfaceRecord> surfaces;
  /// Attributes of the vertices that the records refer to.
  VertexRecords vertices;
  PackedImages images;

  uint64_t size_bytes() const;
};

/// The primitives of a mesh that instances share.
struct MeshRange {
  /// Index of the root of the mesh's tree.
  uint32_t root = 0;
  uint32_t first = 0;
  uint32_t end = 0;
};

/// Tree, primitives and surfaces, ready to be copied to the device.
struct PackedScene {
  /// At least one node; empty if a file contains the nodes. On the device, the records of instances follow.
  UnsetVector<layout::Node> nodes;
  /// The BVH file with the nodes, and these nodes; null if the tree was built. A scene with instances copies its nodes
  /// from the file.
  std::shared_ptr<const BvhFile> file;
  std::span<const layout::Node> nodes_in_file;
  /// The references of the leaves; see TreeView::references.
  UnsetVector<uint32_t> references;
  /// The primitives of the tree in leaf order, then the unbounded primitives; at least one.
  UnsetVector<layout::Primitive> primitives;
  uint32_t unbounded_count = 0;
  PackedSurfaces surfaces;
  PrimitiveNumbers numbers;
  /// Primitives that are left out because they are copies of other primitives.
  DroppedCopies copies;
  /// The number of instances in the tree, and the number of triangles of the meshes that they share.
  uint64_t instance_count = 0;
  uint64_t shared_triangle_count = 0;
  /// The upper level of the tree, which is built again if instances move; null without instances. It writes the records
  /// of instances in this order (UpperNodes::order).
  std::shared_ptr<UpperLevel> upper;
  std::vector<uint32_t> instance_order;
  /// True if the tree was built. It may also be read from a file, or be that of an earlier pose (pack_pose).
  bool is_tree_built = false;
  /// The result of find_mask_cutoffs().
  std::vector<float> mask_cutoffs;
  /// The meshes that instances share, and the number of nodes, which is the index of the first record of an instance.
  std::vector<MeshRange> mesh_ranges;
  uint32_t first_instance = 0;
  /// The features that the geometry uses.
  FeatureMask features;
  /// For each of Scene::materials, whether a visible primitive uses it.
  std::vector<bool> shown_materials;
  /// The number of degenerate triangles, which no ray hits.
  uint64_t degenerate_count = 0;
  /// Center and max-norm radius of the tree's primitives.
  vec4 tree_bounds{0.0F};
  /// Number of entries that the traversal stack needs.
  uint32_t stack_size = 1;
  /// The number of primitives in the tree: all except unbounded ones, copies and degenerate triangles.
  uint32_t bounded_count = 0;
  /// The number of primitives in the tree that are not triangles.
  uint32_t solid_count = 0;
  /// The kinds of primitive in the tree; see TreeView::kinds.
  uint32_t kinds = 0;
  uint64_t geometry_hash = 0;
  BvhStats bvh;
  /// Time for building and packing the tree, or for reading and checking the file, in milliseconds. For a shared tree
  /// that this process built, it includes waiting and writing.
  double bvh_ms = 0.0;
  /// Problems with the file that pack_scene_sharing() used.
  std::vector<Problem> warnings;

  /// Returns the tree; its nodes are in this object or in the file. With instances, nodes and references contain those
  /// of both levels, which pack_instances.h describes. The view is valid as long as this object exists.
  TreeView tree() const;
  uint32_t first_unbounded() const { return static_cast<uint32_t>(references.size()); }
  /// Returns the number of the tree's primitives that belong to no mesh of instances. They come first.
  uint32_t own_primitive_count() const { return mesh_ranges.empty() ? first_unbounded() : mesh_ranges.front().first; }
  /// Returns the number of primitives. A triangle in parts counts once, and degenerate triangles count too.
  uint64_t primitive_count() const { return numbers.first_order.empty() ? 0 : numbers.first_order.back(); }
  /// Returns the size of the records of instances.
  uint64_t record_bytes() const { return instance_order.size() * layout::INSTANCE_RECORDS * sizeof(layout::Node); }
  uint64_t size_bytes() const;
};

/// A scene in world space that a constructor packs and uploads. It is only a parameter of functions: it refers to the
/// scene, so it must not be stored. A temporary scene, or one that a caller gives with std::move(), frees its geometry
/// in between: after packing, it has no objects, meshes or instances.
class SceneToPack {
 public:
  SceneToPack(const world::Scene& scene) : scene_(&scene) {}  // NOLINT(google-explicit-constructor)
  SceneToPack(world::Scene&& scene)                           // NOLINT(google-explicit-constructor)
      : scene_(&scene), temporary_(&scene) {}
  const world::Scene& operator*() const { return *scene_; }
  const world::Scene* operator->() const { return scene_; }
  /// Frees objects, meshes and instances if the scene is temporary.
  void free_geometry() const {
    if (temporary_ == nullptr) return;
    // The assignment of {} would keep the memory.
    std::exchange(temporary_->objects, {});
    std::exchange(temporary_->meshes, {});
    std::exchange(temporary_->instances, {});
  }

 private:
  const world::Scene* scene_;
  world::Scene* temporary_ = nullptr;
};

/// Returns the center and the max-norm radius of a box: on each axis, no corner is farther from the center than the
/// radius. An empty box has the radius 0.
vec4 center_and_radius(const Bounds& box);

/// Packs a checked scene's objects. A temporary scene with instances frees its geometry before the upper level of the
/// tree is built. Throws UsageError for an unknown builder, and RunError if counts exceed the layout
/// (2^27 primitives, 2^24 - 1 nodes). Throws the same errors as pack_images() for images in `texture_bytes`.
PackedScene pack_scene(const SceneToPack& scene, std::string_view builder, const BuildOptions& options = {},
                       uint64_t texture_bytes = kDefaultTextureBytes);

/// Packs a checked scene's objects with the trees of a file, which has a tree for each geometry. Throws InputError for
/// a file that is damaged or belongs to another scene, and RunError like pack_scene().
PackedScene pack_scene_with(const std::filesystem::path& bvh_file, const SceneToPack& scene,
                            uint64_t texture_bytes = kDefaultTextureBytes);

/// The tree of a scene, which is kept for other poses of the scene.
struct KeptTree {
  UnsetVector<layout::Node> nodes;
  UnsetVector<uint32_t> references;
  uint32_t stack_size = 1;
  BvhStats bvh;
  /// The cost that refit_tree() returned when the tree was built.
  double cost = 0.0;
  /// The kinds of the primitives, which determine the order within leaves.
  std::vector<uint8_t> kinds;
};

/// A tree whose cost has grown by more than this factor since it was built is built again (docs/performance_log.md).
inline constexpr double kMostGrowth = 1.2;

/// The choice of a tree for another pose.
enum class TreeOfPose {
  /// The kept tree is fitted to the pose if it has the same primitives and does not become much worse. The choice
  /// depends on the poses alone.
  kRefitted,
  /// The tree is built again.
  kBuilt,
};

/// Packs a checked scene without instances in another pose, without its images. `kept` is the tree of an earlier pose,
/// which may be empty; it becomes the tree of this pose. Throws the same errors as pack_scene().
PackedScene pack_pose(const world::Scene& scene, std::string_view builder, TreeOfPose choice, KeptTree& kept,
                      const BuildOptions& options = {});

/// Returns the alpha cutoff for each image (pack_images). If several masks use an image, the first one counts.
std::vector<float> find_mask_cutoffs(const world::Scene& scene);

/// Adds the images of the scene to a packed scene without images.
void add_images(PackedScene& packed, const world::Scene& scene, uint64_t texture_bytes);

/// Returns a hash of everything in a packed scene with instances that does not depend on their transforms, except its
/// images. Scenes with the same hash differ only in transforms.
uint64_t hash_instanced(const world::Scene& scene);

/// The smallest number of primitives for which a shared tree is kept in a file. The default builder builds smaller
/// trees in a few milliseconds (docs/jobs.md has figures), and access to a file in a shared folder may take as long.
inline constexpr size_t kLeastShared = 100'000;

/// Packs a checked scene's objects with a BVH file that several processes share: the first process builds and writes
/// the file under a lock; the other processes wait and map the file. If the file is damaged or belongs to another
/// scene, the tree is built again. If the file cannot be written, each process builds the tree, with a warning. A tree
/// with fewer primitives than kLeastShared is built without a file. Creates the file's folder if it is missing. Throws
/// the same errors as pack_scene(), and Cancelled if the options' progress returns false, also while waiting.
PackedScene pack_scene_sharing(const std::filesystem::path& bvh_file, const SceneToPack& scene,
                               std::string_view builder, const BuildOptions& options = {},
                               uint64_t texture_bytes = kDefaultTextureBytes);

/// Packs a scene with the tree that the options of a Renderer or a Caster request.
template <typename Options>
PackedScene pack_scene_by(const Options& options, const SceneToPack& scene,
                          uint64_t texture_bytes = kDefaultTextureBytes) {
  if (options.bvh) return pack_scene_with(*options.bvh, scene, texture_bytes);
  const BuildOptions how = {.progress = options.progress};
  if (!options.shared_bvh) return pack_scene(scene, options.builder, how, texture_bytes);
  return pack_scene_sharing(*options.shared_bvh, scene, options.builder, how, texture_bytes);
}

/// Returns the trees of a checked scene for a BVH file: that of the primitives that belong to no instance, then those
/// of the meshes that instances share. Throws the same errors as pack_scene().
std::vector<GeometryTree> build_scene_trees(const world::Scene& scene, std::string_view builder,
                                            const BuildOptions& options);

/// Calls find_tree_faults() for the tree of a scene without instances.
TreeFaults find_tree_faults(const PackedScene& packed, const TreeFaultOptions& options = {});
/// Calls find_tree_faults() for all trees of a scene. Throws InputError if the file lacks one of them.
TreeFaults find_tree_faults(const BvhFile& file, const world::Scene& scene, const TreeFaultOptions& options = {});

}  // namespace promin
