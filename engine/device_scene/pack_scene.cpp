// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_scene.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <utility>

#include "bvh/pack_tree.h"
#include "core/file.h"
#include "core/file_lock.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/rounding.h"
#include "core/stopwatch.h"
#include "device_scene/bundle_images.h"
#include "device_scene/collect_primitives.h"
#include "device_scene/pack_instances.h"
#include "promin/error.h"
#include "scene/alpha.h"
#include "scene/features.h"
#include "scene/texture_slots.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

using namespace layout;

/// The number of triangles or references that a thread processes at a time.
constexpr size_t kPackChunkSize = 16384;

/// The number of entries by which the stack of a tree with instances may grow when they move, before kernels must be
/// compiled again. They are compiled for multiples of 8 entries.
constexpr uint32_t kSpareStack = 4;

/// Time that a process waits for a shared tree that another process is building and that may hang.
constexpr std::chrono::minutes kMostWait{10};

/// Returns the number of primitives that are not triangles.
uint32_t count_solids(const Collected& collected) {
  const auto is_solid = [](const Primitive& p) { return p.c.z != KIND_TRIANGLE; };
  return static_cast<uint32_t>(std::ranges::count_if(collected.bounded, is_solid));
}

/// Packs all parts of a scene except its tree and its images. The tree's references must exist.
void pack_contents(PackedScene& packed, const world::Scene& scene, Collected& collected) {
  packed.features = geometry_features(scene);
  packed.shown_materials = find_shown_materials(scene);
  packed.mask_cutoffs = find_mask_cutoffs(scene);
  packed.numbers = std::move(collected.numbers);
  packed.degenerate_count = collected.degenerate_count;
  const std::span<const uint32_t> references = packed.references;
  UnsetVector<SurfaceRecord>& surfaces = packed.surfaces.surfaces;
  surfaces.resize(references.size());
  packed.primitives.resize(references.size());
  for_each_chunk(references.size(), kPackChunkSize, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      packed.primitives[i] = collected.bounded[references[i]];
      surfaces[i] = collected.bounded_surfaces[references[i]];
    }
  });
  packed.unbounded_count = static_cast<uint32_t>(collected.unbounded.size());
  packed.primitives.insert(packed.primitives.end(), collected.unbounded.begin(), collected.unbounded.end());
  surfaces.insert(surfaces.end(), collected.unbounded_surfaces.begin(), collected.unbounded_surfaces.end());
  if (packed.primitives.empty()) packed.primitives.push_back({});
  packed.surfaces.vertices = std::move(collected.vertices);
  Bounds tree_bounds;
  for (const Bounds& box : collected.boxes) tree_bounds.extend(box);
  packed.tree_bounds = center_and_radius(tree_bounds);
}

/// Builds the tree of the collected primitives.
void build_tree(PackedScene& packed, const world::Scene& scene, const Collected& collected, std::string_view builder,
                const BuildOptions& options) {
  const Stopwatch building;
  GeometryTree tree = build_geometry_tree(collected, scene, builder, options);
  packed.bvh_ms = building.ms();
  packed.is_tree_built = true;
  packed.bvh = tree.stats;
  packed.stack_size = tree.stack_size;
  packed.nodes = std::move(tree.nodes);
  packed.references = std::move(tree.references);
}

/// Uses the tree of a file. Throws InputError if the tree is damaged or belongs to another geometry.
void read_tree(PackedScene& packed, const std::filesystem::path& bvh_file) {
  const auto file = std::make_shared<const BvhFile>(bvh_file);
  const TreeView& tree = file->find(packed.geometry_hash, packed.bounded_count);
  packed.bvh = tree.stats;
  packed.stack_size = tree.stack_size;
  packed.references.assign(tree.references.begin(), tree.references.end());
  packed.nodes_in_file = tree.nodes;
  packed.file = file;
}

/// Calls `read` if the file exists. Returns whether it could be read. If the file has faults, they replace the
/// warnings.
template <typename Read>
bool can_read(const std::filesystem::path& bvh_file, std::vector<Problem>& warnings, const Read& read) {
  warnings.clear();
  std::error_code error;
  if (!std::filesystem::exists(bvh_file, error)) return false;
  try {
    read();
    return true;
  } catch (const InputError& refusal) {
    const Problem& problem = refusal.problems().front();
    warnings = {Problem{problem.code, problem.what, problem.where, "it is built again"}};
    return false;
  }
}

/// Calls `read`, which reads the file. If the file does not exist or has faults, calls `build`, which returns trees,
/// and writes them to the file for other processes, which wait for it.
template <typename Read, typename Build>
void share_trees(const std::filesystem::path& bvh_file, const BuildOptions& options, std::vector<Problem>& warnings,
                 const Read& read, const Build& build) {
  // A file appears completely or not at all, so reading needs no lock.
  if (can_read(bvh_file, warnings, read)) return;
  const std::filesystem::path folder = bvh_file.parent_path();
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  const FileLock lock(std::filesystem::path(bvh_file).replace_extension(".lock"), kMostWait, options.progress);
  if (can_read(bvh_file, warnings, read)) return;
  clear_leftovers(folder);
  const std::vector<TreeView> trees = build();
  try {
    write_bvh_file(bvh_file, trees);
  } catch (const RunError& failure) {
    warnings.push_back(failure.problems().front());
  }
}

/// The geometries of a scene: its own primitives, which belong to no instance, and the meshes that instances share.
struct Geometries {
  Collected own;
  DroppedCopies copies;
  std::vector<Collected> meshes;
  /// True if there are more primitives than numbers (PrimitiveNumbers::are_instances_whole).
  bool are_instances_whole = false;

  size_t bounded_count() const {
    size_t count = own.bounded.size();
    for (const Collected& mesh : meshes) count += mesh.bounded.size();
    return count;
  }
};

/// Returns the number of numbers that each object takes if it is an instance. If there are too many primitives for 32
/// bits, an instance takes one number.
std::vector<uint32_t> count_numbers(const world::Scene& scene, Geometries& geometries) {
  constexpr uint64_t kMostNumbers = NO_ORDER;
  uint64_t total = 0;
  for (const world::Object& object : scene.objects) total += world::primitive_count(object.shape);
  for (const world::Instance& instance : scene.instances) total += geometries.meshes[instance.mesh].order;
  geometries.are_instances_whole = total >= kMostNumbers;
  if (geometries.are_instances_whole) {
    for (Collected& mesh : geometries.meshes) {
      mesh.order = 1;
      mesh.numbers.parts.clear();
      for (Primitive& primitive : mesh.bounded) primitive.c.y = 0;
    }
  }
  std::vector<uint32_t> numbers(scene.objects.size(), 0);
  for (const world::Instance& instance : scene.instances) {
    numbers[instance.object] = geometries.meshes[instance.mesh].order;
  }
  return numbers;
}

Geometries collect_geometries(const world::Scene& scene) {
  Geometries geometries;
  for (const Mesh& mesh : scene.meshes) {
    world::Scene alone;
    alone.file = scene.file;
    alone.objects.push_back({"", mesh});
    geometries.meshes.push_back(collect_primitives(alone));
  }
  geometries.own = collect_primitives(scene, count_numbers(scene, geometries));
  geometries.copies = drop_copies(scene, geometries.own);
  return geometries;
}

/// Returns the trees of the own primitives and of the meshes, in this order. Trees of meshes have their top boxes and
/// no binary tree. `make_tree` returns the tree of collected primitives.
template <typename MakeTree>
std::vector<GeometryTree> make_trees(const Geometries& geometries, const MakeTree& make_tree) {
  std::vector<GeometryTree> trees;
  trees.push_back(make_tree(geometries.own));
  for (const Collected& mesh : geometries.meshes) {
    trees.push_back(make_tree(mesh));
    keep_top_boxes(trees.back());
  }
  return trees;
}

std::vector<GeometryTree> build_trees(const Geometries& geometries, const world::Scene& scene, std::string_view builder,
                                      const BuildOptions& options) {
  return make_trees(geometries, [&](const Collected& collected) {
    GeometryTree tree = build_geometry_tree(collected, scene, builder, options);
    tree.geometry_hash = hash_geometry(collected);
    return tree;
  });
}

std::vector<GeometryTree> read_trees(const Geometries& geometries, const std::filesystem::path& bvh_file) {
  const BvhFile file(bvh_file);
  return make_trees(geometries, [&](const Collected& collected) { return read_geometry_tree(collected, file); });
}

std::vector<TreeView> views_of(std::span<const GeometryTree> trees) {
  std::vector<TreeView> views;
  for (const GeometryTree& tree : trees) views.push_back(tree.view());
  return views;
}

/// Adds the vertices of a mesh behind all others. Returns the index of the first one.
uint32_t append_vertices(const VertexRecords& from, VertexRecords& to) {
  const size_t first = to.count();
  const auto append = [&](const std::vector<vec4>& records, std::vector<vec4>& all) {
    if (records.empty()) return;
    all.resize(first);
    all.insert(all.end(), records.begin(), records.end());
  };
  append(from.normals, to.normals);
  append(from.colors, to.colors);
  append(from.uvs, to.uvs);
  append(from.tangents, to.tangents);
  return static_cast<uint32_t>(first);
}

/// Inserts the primitives and surfaces of meshes between the primitives of the tree and the unbounded ones.
void insert_meshes(PackedScene& packed, std::vector<PackedMesh>& meshes, size_t own_count) {
  if (own_count + packed.unbounded_count == 0) packed.primitives.clear();
  UnsetVector<Primitive> primitives;
  UnsetVector<SurfaceRecord> surfaces;
  for (PackedMesh& mesh : meshes) {
    const uint32_t first_vertex = append_vertices(mesh.vertices, packed.surfaces.vertices);
    primitives.insert(primitives.end(), mesh.primitives.begin(), mesh.primitives.end());
    for (SurfaceRecord surface : mesh.surfaces) {
      if ((surface.corners_material.w & ~SURFACE_MATERIAL_MASK) != 0) {
        surface.corners_material += uvec4(uvec3(first_vertex), 0);
      }
      surfaces.push_back(surface);
    }
    packed.shared_triangle_count += mesh.primitives.size() + mesh.degenerate_count;
    std::exchange(mesh.primitives, {});
    std::exchange(mesh.surfaces, {});
    mesh.vertices = {};
  }
  const auto at = static_cast<std::ptrdiff_t>(own_count);
  packed.primitives.insert(packed.primitives.begin() + at, primitives.begin(), primitives.end());
  packed.surfaces.surfaces.insert(packed.surfaces.surfaces.begin() + at, surfaces.begin(), surfaces.end());
  if (packed.primitives.empty()) packed.primitives.push_back({});
  packed.references.resize(own_count + primitives.size());
  std::fill(packed.references.begin() + at, packed.references.end(), 0U);
}

/// Returns the statistics of a tree of two levels.
BvhStats stats_of(const BvhStats& upper, const BvhStats& own, const std::vector<PackedMesh>& meshes) {
  BvhStats stats = upper;
  stats.builder = own.builder;
  stats.nodes += own.nodes;
  stats.leaves += own.leaves;
  stats.max_leaf_size = std::max(stats.max_leaf_size, own.max_leaf_size);
  uint32_t depth = own.depth;
  for (const PackedMesh& mesh : meshes) {
    stats.nodes += mesh.bvh.nodes;
    stats.leaves += mesh.bvh.leaves;
    stats.max_leaf_size = std::max(stats.max_leaf_size, mesh.bvh.max_leaf_size);
    depth = std::max(depth, mesh.bvh.depth);
  }
  stats.depth += depth;
  return stats;
}

/// Adds the numbers of instances.
void number_instances(PackedScene& packed, const world::Scene& scene, const std::vector<PackedMesh>& meshes) {
  packed.numbers.mesh_of_object.assign(scene.objects.size(), PrimitiveNumbers::kNoMesh);
  for (const world::Instance& instance : scene.instances) {
    packed.numbers.mesh_of_object[instance.object] = instance.mesh;
    packed.degenerate_count += meshes[instance.mesh].degenerate_count;
  }
}

/// Packs a scene with instances and its trees (make_trees), without its images.
PackedScene pack_two_levels(const SceneToPack& to_pack, Geometries geometries, std::vector<GeometryTree> trees,
                            const BuildOptions& options) {
  const world::Scene& scene = *to_pack;
  const Stopwatch packing;
  std::vector<PackedMesh> meshes;
  for (size_t i = 0; i < geometries.meshes.size(); ++i) {
    meshes.push_back(pack_mesh(std::move(geometries.meshes[i]), std::move(trees[i + 1])));
  }
  Collected& collected = geometries.own;
  GeometryTree& own = trees.front();
  PackedScene packed;
  packed.copies = std::move(geometries.copies);
  packed.solid_count = count_solids(collected);
  packed.kinds = own.kinds | 1U << KIND_TRIANGLE;
  const size_t own_count = own.references.size();
  size_t reference_count = own_count;
  packed.bounded_count = static_cast<uint32_t>(collected.bounded.size());
  for (const PackedMesh& mesh : meshes) {
    reference_count += mesh.primitives.size();
    packed.bounded_count += mesh.bounded_count;
  }
  check_at_most(CHILD_INSTANCE_INDEX, reference_count, scene, "the tree refers to", "parts of primitives",
                ", or use the builder sah", Setting::kBuilder);
  Bounds own_bounds;
  for (const Bounds& box : collected.boxes) own_bounds.extend(box);
  packed.references = std::move(own.references);
  pack_contents(packed, scene, collected);
  packed.numbers.are_instances_whole = geometries.are_instances_whole;
  number_instances(packed, scene, meshes);
  for (PackedMesh& mesh : meshes) packed.numbers.mesh_parts.push_back(std::move(mesh.parts));
  const TwoLevels levels{
      scene, own.binary, own_bounds, static_cast<uint32_t>(own_count), meshes, packed.numbers.first_order};
  packed.upper = std::make_shared<UpperLevel>(levels, options);
  // The upper level has its own data of instances.
  to_pack.free_geometry();
  UpperNodes upper = packed.upper->build(options);
  check_at_most(MAX_NODES, upper.first_record, scene, "the scene's tree has", "nodes");
  check_at_most(CHILD_INSTANCE_INDEX, upper.first_record + upper.record_count(), scene, "the scene's tree has",
                "nodes and instances");
  packed.nodes = packed.upper->join(levels, upper);
  packed.bvh_ms = packing.ms();
  packed.bvh = stats_of(upper.stats, own.stats, meshes);
  packed.instance_order = std::move(upper.order);
  packed.bvh.bytes = packed.nodes.size() * sizeof(Node) + packed.record_bytes();
  packed.stack_size = upper.stack_size + kSpareStack;
  packed.instance_count = packed.upper->instance_count();
  packed.first_instance = upper.first_record;
  auto first = static_cast<uint32_t>(own_count);
  for (size_t i = 0; i < meshes.size(); ++i) {
    const uint32_t end = first + static_cast<uint32_t>(meshes[i].primitives.size());
    packed.mesh_ranges.push_back({packed.upper->root_of(i), first, end});
    first = end;
  }
  packed.tree_bounds = center_and_radius(upper.bounds);
  insert_meshes(packed, meshes, own_count);
  return packed;
}

/// Packs a scene without instances and without its images, with the tree that `make_tree` makes.
template <typename MakeTree>
PackedScene pack_one_level(const world::Scene& scene, const MakeTree& make_tree) {
  Geometries geometries = collect_geometries(scene);
  const Collected& own = geometries.own;
  PackedScene packed;
  packed.copies = std::move(geometries.copies);
  packed.bounded_count = static_cast<uint32_t>(own.bounded.size());
  packed.kinds = kinds_of(own);
  packed.solid_count = count_solids(own);
  make_tree(packed, own);
  pack_contents(packed, scene, geometries.own);
  return packed;
}

/// The way to the trees of a scene: they are built, or read from a file, or shared with other processes.
class TreeSource {
 public:
  /// The trees are built.
  TreeSource(std::string_view builder, const BuildOptions& options) : builder_(builder), options_(options) {}
  /// The trees are read.
  explicit TreeSource(const std::filesystem::path& file) : file_(&file) {}
  /// The trees are shared.
  TreeSource(std::string_view builder, const BuildOptions& options, const std::filesystem::path& file)
      : builder_(builder), options_(options), file_(&file), is_shared_(true) {}

  PackedScene make_packed(const SceneToPack& scene, uint64_t texture_bytes) const {
    PackedScene packed = scene->instances.empty() ? pack_without_instances(*scene) : pack_with_instances(scene);
    add_images(packed, *scene, texture_bytes);
    return packed;
  }

 private:
  PackedScene pack_without_instances(const world::Scene& scene) const {
    return pack_one_level(scene, [&](PackedScene& packed, const Collected& own) {
      packed.geometry_hash = hash_geometry(own);
      packed.bvh_ms = get(
          packed.bounded_count, packed.warnings, [&] { read_tree(packed, *file_); },
          [&] {
            build_tree(packed, scene, own, builder_, options_);
            return std::vector<TreeView>{packed.tree()};
          });
    });
  }

  PackedScene pack_with_instances(const SceneToPack& scene) const {
    Geometries geometries = collect_geometries(*scene);
    std::vector<GeometryTree> trees;
    std::vector<Problem> warnings;
    bool is_built = false;
    const double trees_ms = get(
        geometries.bounded_count(), warnings, [&] { trees = read_trees(geometries, *file_); },
        [&] {
          trees = build_trees(geometries, *scene, builder_, options_);
          is_built = true;
          return views_of(trees);
        });
    PackedScene packed = pack_two_levels(scene, std::move(geometries), std::move(trees), options_);
    packed.bvh_ms += trees_ms;
    packed.is_tree_built = is_built;
    packed.warnings = std::move(warnings);
    return packed;
  }

  /// Calls `read` or `build`, or both. Returns the time in milliseconds.
  template <typename Read, typename Build>
  double get(size_t bounded_count, std::vector<Problem>& warnings, const Read& read, const Build& build) const {
    const Stopwatch getting;
    if (file_ == nullptr || (is_shared_ && bounded_count < kLeastShared)) {
      build();
    } else if (is_shared_) {
      share_trees(*file_, options_, warnings, read, build);
    } else {
      read();
    }
    return getting.ms();
  }

  std::string_view builder_;
  BuildOptions options_;
  const std::filesystem::path* file_ = nullptr;
  bool is_shared_ = false;
};

/// Returns whether a tree over the primitives is a tree over others with these kinds.
bool has_kinds(const KeptTree& kept, std::span<const Primitive> bounded) {
  return !kept.nodes.empty() &&
         std::ranges::equal(kept.kinds, bounded, {}, {}, [](const Primitive& p) { return p.c.z; });
}

/// Keeps the tree of a packed scene, unless some of its boxes contain only parts of primitives.
void keep_tree(const PackedScene& packed, const Collected& collected, KeptTree& kept) {
  kept = {};
  if (packed.references.size() != packed.bounded_count) return;
  kept.nodes = packed.nodes;
  kept.references = packed.references;
  kept.stack_size = packed.stack_size;
  kept.bvh = packed.bvh;
  for (const Primitive& p : collected.bounded) kept.kinds.push_back(static_cast<uint8_t>(p.c.z));
  kept.cost = refit_tree(kept.nodes, kept.references, collected.boxes);
}

}  // namespace

vec4 center_and_radius(const Bounds& box) {
  if (box.is_empty()) return vec4(0.0F);
  const vec3 center = box.center();
  const dvec3 reach = glm::max(dvec3(box.hi) - dvec3(center), dvec3(center) - dvec3(box.lo));
  return {center, round_up(std::max({reach.x, reach.y, reach.z}))};
}

std::vector<float> find_mask_cutoffs(const world::Scene& scene) {
  std::vector<float> cutoffs(scene.images.size(), 0.0F);
  for (const Material& material : scene.materials) {
    const TextureSlot& slot = base_slot(material);
    // A scene for casts has no textures.
    if (material.alpha_mode != AlphaMode::kMask || is_absent(material) || slot.texture >= scene.textures.size())
      continue;
    float& cutoff = cutoffs[scene.textures[slot.texture].image];
    if (cutoff == 0.0F) cutoff = material.alpha_cutoff / material.alpha;
  }
  // Materials that blend somewhere are not changed.
  for (const Material& material : scene.materials) {
    const TextureSlot& slot = base_slot(material);
    const bool blends_texels = material.alpha_mode == AlphaMode::kBlend && slot.texture < scene.textures.size();
    if (blends_texels) cutoffs[scene.textures[slot.texture].image] = 0.0F;
  }
  return cutoffs;
}

void add_images(PackedScene& packed, const world::Scene& scene, uint64_t texture_bytes) {
  packed.surfaces.images = pack_images(scene.images, scene.textures, texture_bytes, packed.mask_cutoffs,
                                       find_image_bundles(scene, packed.mask_cutoffs));
  const auto is_bundled = [](const PlacedImage& image) { return image.stride > 1; };
  if (std::ranges::any_of(packed.surfaces.images.images, is_bundled)) packed.features |= FEATURE_TEXTURE_BUNDLES;
}

TreeView PackedScene::tree() const {
  const std::span<const Node> all = file ? nodes_in_file : std::span<const Node>(nodes);
  return {all, references, bounded_count, stack_size, kinds, geometry_hash, bvh};
}

uint64_t PackedSurfaces::size_bytes() const {
  uint64_t bytes = std::as_bytes(std::span(surfaces)).size() + std::as_bytes(std::span(images.words)).size();
  for (const auto* records : {&vertices.normals, &vertices.colors, &vertices.uvs, &vertices.tangents}) {
    bytes += std::as_bytes(std::span(*records)).size();
  }
  return bytes;
}

uint64_t PackedScene::size_bytes() const {
  return tree().nodes.size_bytes() + record_bytes() + std::as_bytes(std::span(primitives)).size() +
         surfaces.size_bytes();
}

PackedScene pack_scene(const SceneToPack& scene, std::string_view builder, const BuildOptions& options,
                       uint64_t texture_bytes) {
  return TreeSource(builder, options).make_packed(scene, texture_bytes);
}

PackedScene pack_pose(const world::Scene& scene, std::string_view builder, TreeOfPose choice, KeptTree& kept,
                      const BuildOptions& options) {
  return pack_one_level(scene, [&](PackedScene& packed, const Collected& collected) {
    const Stopwatch fitting;
    if (choice == TreeOfPose::kRefitted && has_kinds(kept, collected.bounded)) {
      const double cost = refit_tree(kept.nodes, kept.references, collected.boxes);
      if (cost <= kMostGrowth * kept.cost) {
        packed.nodes = kept.nodes;
        packed.references = kept.references;
        packed.stack_size = kept.stack_size;
        packed.bvh = kept.bvh;
        packed.bvh_ms = fitting.ms();
        return;
      }
    }
    build_tree(packed, scene, collected, builder, options);
    if (choice == TreeOfPose::kRefitted) keep_tree(packed, collected, kept);
  });
}

uint64_t hash_instanced(const world::Scene& scene) {
  Hash64 hash;
  const auto add = [&](const auto& records) {
    hash.add(records.size());
    hash.add(std::as_bytes(std::span(records)));
  };
  for (const Mesh& mesh : scene.meshes) {
    add(mesh.positions);
    add(mesh.triangles);
    add(mesh.normals);
    add(mesh.colors);
    add(mesh.uvs);
    add(mesh.tangents);
    add(mesh.triangle_materials);
  }
  for (const world::Instance& instance : scene.instances) {
    hash.add(instance.object | uint64_t{instance.mesh} << 32);
    hash.add(scene.objects[instance.object].material);
  }
  const Collected own = collect_primitives(scene);
  add(own.bounded);
  add(own.bounded_surfaces);
  add(own.unbounded);
  add(own.unbounded_surfaces);
  add(own.vertices.normals);
  add(own.vertices.colors);
  add(own.vertices.uvs);
  add(own.vertices.tangents);
  add(own.numbers.first_order);
  return hash.value();
}

PackedScene pack_scene_with(const std::filesystem::path& bvh_file, const SceneToPack& scene, uint64_t texture_bytes) {
  return TreeSource(bvh_file).make_packed(scene, texture_bytes);
}

PackedScene pack_scene_sharing(const std::filesystem::path& bvh_file, const SceneToPack& scene,
                               std::string_view builder, const BuildOptions& options, uint64_t texture_bytes) {
  return TreeSource(builder, options, bvh_file).make_packed(scene, texture_bytes);
}

std::vector<GeometryTree> build_scene_trees(const world::Scene& scene, std::string_view builder,
                                            const BuildOptions& options) {
  std::vector<GeometryTree> trees = build_trees(collect_geometries(scene), scene, builder, options);
  trees.front().binary = {};
  return trees;
}

TreeFaults find_tree_faults(const PackedScene& packed, const TreeFaultOptions& options) {
  return find_tree_faults(packed.tree(), packed.primitives, packed.numbers, options);
}

TreeFaults find_tree_faults(const BvhFile& file, const world::Scene& scene, const TreeFaultOptions& options) {
  const Geometries geometries = collect_geometries(scene);
  TreeFaults all;
  const auto add_faults = [&](const Collected& collected, const auto& place) {
    const TreeView& tree = file.find(hash_geometry(collected), collected.bounded.size());
    UnsetVector<Primitive> primitives;
    primitives.resize(tree.references.size());
    for (size_t i = 0; i < primitives.size(); ++i) primitives[i] = collected.bounded[tree.references[i]];
    const TreeFaults faults = find_tree_faults(tree, primitives, collected.numbers, options);
    if (all.count == 0 && faults.count > 0) all.first = place() + faults.first;
    all.count += faults.count;
  };
  add_faults(geometries.own, [] { return std::string(); });
  for (uint32_t i = 0; i < geometries.meshes.size(); ++i) {
    add_faults(geometries.meshes[i], [&] {
      const auto instance = std::ranges::find(scene.instances, i, &world::Instance::mesh);
      return "in the mesh of object " + std::to_string(instance->object) + ", ";
    });
  }
  return all;
}

}  // namespace promin
