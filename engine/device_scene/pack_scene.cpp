// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_scene.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <system_error>

#include "bvh/clip_triangle.h"
#include "bvh/pack_tree.h"
#include "bvh/read_node.h"
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

/// Clips a primitive for builders that split primitives: triangles exactly, other shapes by their boxes.
Bounds clip(const Primitive& p, const Bounds& window) {
  if (p.c.z != KIND_TRIANGLE) return window;
  return clip_triangle(triangle_corners(p), window);
}

/// Returns the tree's references, sorted by kind within each leaf, because traversal tests the primitives of a leaf
/// kind by kind.
UnsetVector<uint32_t> sort_leaves_by_kind(const Bvh& bvh, std::span<const Primitive> bounded) {
  UnsetVector<uint32_t> references = bvh.references;
  const auto is_before = [&](uint32_t a, uint32_t b) { return bounded[a].c.z < bounded[b].c.z; };
  for_each_chunk(bvh.nodes.size(), kPackChunkSize, 0, [&](size_t begin, size_t end) {
    for (const BvhNode& node : std::span(bvh.nodes).subspan(begin, end - begin)) {
      if (node.count == 0) continue;
      const auto first = references.begin() + node.first;
      if (!std::is_sorted(first, first + node.count, is_before)) std::stable_sort(first, first + node.count, is_before);
    }
  });
  return references;
}

/// Returns a hash of the geometry. It does not depend on the assignment of primitives to objects.
uint64_t hash_geometry(std::span<const Primitive> bounded) {
  Hash64 hash;
  hash.add(bounded.size());
  for (const Primitive& p : bounded) {
    const std::array words = {p.a, p.b};
    hash.add(std::as_bytes(std::span(words)));
    hash.add(p.c.x | uint64_t{p.c.z} << 32);
  }
  return hash.value();
}

/// Sets the kinds of the primitives and the number of primitives that are not triangles.
void count_kinds(PackedScene& packed, std::span<const Primitive> bounded) {
  std::array<uint32_t, 32> counts{};  // One count for each bit of the kinds.
  for (const Primitive& p : bounded) ++counts[p.c.z];
  for (uint32_t kind = 0; kind < counts.size(); ++kind) packed.kinds |= uint32_t{counts[kind] > 0} << kind;
  packed.solid_count = static_cast<uint32_t>(bounded.size()) - counts[KIND_TRIANGLE];
}

/// Packs all parts of a scene except its tree and its images. The tree's references must exist.
void pack_contents(PackedScene& packed, const world::Scene& scene, Collected& collected) {
  packed.numbers = std::move(collected.numbers);
  packed.features = geometry_features(scene);
  packed.shown_materials = find_shown_materials(scene);
  packed.mask_cutoffs = find_mask_cutoffs(scene);
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

/// Builds a tree over the collected primitives.
Bvh build_own_tree(const Collected& collected, std::string_view builder, const BuildOptions& options) {
  return build_bvh(builder,
                   {collected.boxes, [&](uint32_t primitive,
                                         const Bounds& window) { return clip(collected.bounded[primitive], window); }},
                   options);
}

/// Builds the tree of the collected primitives.
void build_tree(PackedScene& packed, const world::Scene& scene, const Collected& collected, std::string_view builder,
                const BuildOptions& options) {
  const Stopwatch building;
  const Bvh bvh = build_own_tree(collected, builder, options);
  check_at_most(CHILD_FIRST_MASK, bvh.references.size(), scene, "the tree refers to", "parts of primitives",
                ", or use the builder sah", Setting::kBuilder);
  packed.bvh_ms = building.ms();
  packed.bvh = measure_bvh(builder, bvh);
  PackedTree tree = pack_tree(bvh);
  check_at_most(MAX_NODES, tree.nodes.size(), scene, "the scene's tree has", "nodes");
  packed.nodes = std::move(tree.nodes);
  packed.stack_size = tree.stack_size;
  packed.bvh.bytes = packed.nodes.size() * sizeof(Node);
  packed.references = sort_leaves_by_kind(bvh, collected.bounded);
}

/// Uses the tree of a file. Throws InputError if the tree is damaged or belongs to another geometry.
void read_tree(PackedScene& packed, const std::filesystem::path& bvh_file) {
  const Stopwatch reading;
  const auto file = std::make_shared<const BvhFile>(bvh_file);
  file->check_scene(packed.geometry_hash, packed.bounded_count);
  packed.bvh_ms = reading.ms();
  const TreeView& tree = file->tree();
  packed.bvh = tree.stats;
  packed.stack_size = tree.stack_size;
  packed.references.assign(tree.references.begin(), tree.references.end());
  packed.file = file;
}

/// Returns whether the file contains the scene's tree. If the file exists and has faults, they replace the warnings.
bool find_shared_tree(PackedScene& packed, const std::filesystem::path& bvh_file) {
  packed.warnings.clear();
  std::error_code error;
  if (!std::filesystem::exists(bvh_file, error)) return false;
  try {
    read_tree(packed, bvh_file);
    return true;
  } catch (const InputError& refusal) {
    const Problem& problem = refusal.problems().front();
    packed.warnings = {Problem{problem.code, problem.what, problem.where, "it is built again"}};
    return false;
  }
}

/// Uses the tree of the file. If there is none, builds the tree and writes the file for other processes, which wait for
/// it.
void share_tree(PackedScene& packed, const world::Scene& scene, const Collected& collected, std::string_view builder,
                const BuildOptions& options, const std::filesystem::path& bvh_file) {
  const Stopwatch sharing;
  // A file appears completely or not at all, so reading needs no lock.
  if (find_shared_tree(packed, bvh_file)) return;
  const std::filesystem::path folder = bvh_file.parent_path();
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  const FileLock lock(std::filesystem::path(bvh_file).replace_extension(".lock"), kMostWait, options.progress);
  if (find_shared_tree(packed, bvh_file)) return;
  clear_leftovers(folder);
  build_tree(packed, scene, collected, builder, options);
  try {
    write_bvh_file(bvh_file, packed.tree());
  } catch (const RunError& failure) {
    packed.warnings.push_back(failure.problems().front());
  }
  packed.bvh_ms = sharing.ms();
}

/// Returns the meshes of a scene, each with its tree.
std::vector<PackedMesh> pack_meshes(const world::Scene& scene, std::string_view builder, const BuildOptions& options) {
  std::vector<PackedMesh> meshes;
  for (const Mesh& mesh : scene.meshes) {
    world::Scene alone;
    alone.file = scene.file;
    alone.objects.push_back({"", mesh});
    meshes.push_back(pack_mesh(alone, builder, options));
  }
  return meshes;
}

/// Returns the number of numbers that each object takes if it is an instance. If there are too many primitives for 32
/// bits, an instance takes one number.
std::vector<uint32_t> count_numbers(const world::Scene& scene, std::vector<PackedMesh>& meshes, bool& are_whole) {
  constexpr uint64_t kMostNumbers = NO_ORDER;
  uint64_t total = 0;
  for (const world::Object& object : scene.objects) total += world::primitive_count(object.shape);
  for (const world::Instance& instance : scene.instances) total += meshes[instance.mesh].number_count;
  are_whole = total >= kMostNumbers;
  if (are_whole) {
    for (PackedMesh& mesh : meshes) {
      mesh.number_count = 1;
      mesh.parts.clear();
      for (Primitive& primitive : mesh.primitives) primitive.c.y = 0;
    }
  }
  std::vector<uint32_t> numbers(scene.objects.size(), 0);
  for (const world::Instance& instance : scene.instances) {
    numbers[instance.object] = meshes[instance.mesh].number_count;
  }
  return numbers;
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
    mesh.primitives = {};
    mesh.surfaces = {};
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
BvhStats stats_of(std::string_view builder, const BvhStats& upper, const Bvh& own,
                  const std::vector<PackedMesh>& meshes) {
  BvhStats stats = upper;
  stats.builder = builder;
  const BvhStats below = measure_bvh(builder, own);
  stats.nodes += below.nodes;
  stats.leaves += below.leaves;
  stats.max_leaf_size = std::max(stats.max_leaf_size, below.max_leaf_size);
  uint32_t depth = below.depth;
  for (const PackedMesh& mesh : meshes) {
    stats.nodes += mesh.bvh.nodes;
    stats.leaves += mesh.bvh.leaves;
    stats.max_leaf_size = std::max(stats.max_leaf_size, mesh.bvh.max_leaf_size);
    depth = std::max(depth, mesh.bvh.depth);
  }
  stats.depth += depth;
  return stats;
}

/// Packs a scene with instances.
PackedScene pack_two_levels(const world::Scene& scene, uint64_t texture_bytes, std::string_view builder,
                            const BuildOptions& options) {
  const Stopwatch building;
  std::vector<PackedMesh> meshes = pack_meshes(scene, builder, options);
  PackedScene packed;
  bool are_whole = false;
  Collected collected = collect_primitives(scene, count_numbers(scene, meshes, are_whole));
  packed.copies = drop_copies(scene, collected);
  count_kinds(packed, collected.bounded);
  packed.kinds |= 1U << KIND_TRIANGLE;
  const Bvh own = build_own_tree(collected, builder, options);
  packed.references = sort_leaves_by_kind(own, collected.bounded);
  const size_t own_count = packed.references.size();
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
  const TwoLevels levels{
      scene, own, own_bounds, static_cast<uint32_t>(own_count), meshes, collected.numbers.first_order};
  packed.upper = std::make_shared<UpperLevel>(levels, options);
  const UpperNodes upper = packed.upper->build(options);
  check_at_most(MAX_NODES, upper.first_record, scene, "the scene's tree has", "nodes");
  check_at_most(CHILD_INSTANCE_INDEX, upper.first_record + upper.records.size(), scene, "the scene's tree has",
                "nodes and instances");
  packed.nodes = packed.upper->join(levels, upper);
  packed.bvh_ms = building.ms();
  packed.bvh = stats_of(builder, upper.stats, own, meshes);
  packed.bvh.bytes = packed.nodes.size() * sizeof(Node);
  packed.stack_size = upper.stack_size + kSpareStack;
  packed.instance_count = packed.upper->instance_count();
  packed.first_instance = upper.first_record;
  auto first = static_cast<uint32_t>(own_count);
  for (size_t i = 0; i < meshes.size(); ++i) {
    const uint32_t end = first + static_cast<uint32_t>(meshes[i].primitives.size());
    packed.mesh_ranges.push_back({packed.upper->root_of(i), first, end});
    first = end;
  }
  pack_contents(packed, scene, collected);
  add_images(packed, scene, texture_bytes);
  packed.tree_bounds = center_and_radius(upper.bounds);
  packed.numbers.are_instances_whole = are_whole;
  packed.numbers.mesh_of_object.assign(scene.objects.size(), PrimitiveNumbers::kNoMesh);
  for (const world::Instance& instance : scene.instances) {
    packed.numbers.mesh_of_object[instance.object] = instance.mesh;
  }
  for (PackedMesh& mesh : meshes) packed.numbers.mesh_parts.push_back(std::move(mesh.parts));
  for (const world::Instance& instance : scene.instances) {
    packed.degenerate_count += meshes[instance.mesh].degenerate_count;
  }
  insert_meshes(packed, meshes, own_count);
  return packed;
}

/// Packs a scene without its images, with the tree that `make_tree` makes.
template <typename MakeTree>
PackedScene pack_world(const world::Scene& scene, const MakeTree& make_tree) {
  Collected collected = collect_primitives(scene);
  PackedScene packed;
  packed.copies = drop_copies(scene, collected);
  packed.bounded_count = static_cast<uint32_t>(collected.bounded.size());
  count_kinds(packed, collected.bounded);
  make_tree(packed, collected);
  pack_contents(packed, scene, collected);
  return packed;
}

/// Packs a scene with the tree that `make_tree` makes, which may read the hash of the geometry.
template <typename MakeTree>
PackedScene pack_world(const world::Scene& scene, uint64_t texture_bytes, const MakeTree& make_tree) {
  PackedScene packed = pack_world(scene, [&](PackedScene& next, const Collected& collected) {
    next.geometry_hash = hash_geometry(collected.bounded);
    make_tree(next, collected);
  });
  add_images(packed, scene, texture_bytes);
  return packed;
}

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
  if (file) return file->tree();
  return {nodes, references, bounded_count, stack_size, kinds, geometry_hash, bvh};
}

uint64_t PackedSurfaces::size_bytes() const {
  uint64_t bytes = std::as_bytes(std::span(surfaces)).size() + std::as_bytes(std::span(images.words)).size();
  for (const auto* records : {&vertices.normals, &vertices.colors, &vertices.uvs, &vertices.tangents}) {
    bytes += std::as_bytes(std::span(*records)).size();
  }
  return bytes;
}

uint64_t PackedScene::size_bytes() const {
  return tree().nodes.size_bytes() + std::as_bytes(std::span(primitives)).size() + surfaces.size_bytes();
}

TreeFaults find_tree_faults(const PackedScene& packed, const TreeFaultOptions& options) {
  return find_tree_faults(packed.tree(), packed.primitives, packed.numbers, options);
}

PackedScene pack_scene(const world::Scene& scene, std::string_view builder, const BuildOptions& options,
                       uint64_t texture_bytes) {
  if (!scene.instances.empty()) return pack_two_levels(scene, texture_bytes, builder, options);
  return pack_world(scene, texture_bytes, [&](PackedScene& packed, const Collected& collected) {
    build_tree(packed, scene, collected, builder, options);
  });
}

PackedScene pack_pose(const world::Scene& scene, std::string_view builder, TreeOfPose choice, KeptTree& kept,
                      const BuildOptions& options) {
  return pack_world(scene, [&](PackedScene& packed, const Collected& collected) {
    const Stopwatch fitting;
    if (choice == TreeOfPose::kRefitted && has_kinds(kept, collected.bounded)) {
      const double cost = refit_tree(kept.nodes, kept.references, collected.boxes);
      if (cost <= kMostGrowth * kept.cost) {
        packed.nodes = kept.nodes;
        packed.references = kept.references;
        packed.stack_size = kept.stack_size;
        packed.bvh = kept.bvh;
        packed.bvh_ms = fitting.ms();
        packed.is_tree_fitted = true;
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

PackedScene pack_scene_with(const std::filesystem::path& bvh_file, const world::Scene& scene, uint64_t texture_bytes) {
  if (!scene.instances.empty()) {
    throw InputError({"bvh.instances", "the scene has instances, but a BVH file has the triangles of all objects",
                      bvh_file.string(), "build the tree, or draw no object as an instance", Setting::kInstances});
  }
  return pack_world(scene, texture_bytes,
                    [&](PackedScene& packed, const Collected& /*collected*/) { read_tree(packed, bvh_file); });
}

PackedScene pack_scene_sharing(const std::filesystem::path& bvh_file, const world::Scene& scene,
                               std::string_view builder, const BuildOptions& options, uint64_t texture_bytes) {
  if (!scene.instances.empty()) return pack_two_levels(scene, texture_bytes, builder, options);
  return pack_world(scene, texture_bytes, [&](PackedScene& packed, const Collected& collected) {
    if (packed.bounded_count < kLeastShared) return build_tree(packed, scene, collected, builder, options);
    share_tree(packed, scene, collected, builder, options, bvh_file);
  });
}

}  // namespace promin
