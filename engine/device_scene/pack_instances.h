// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bvh/builder.h"
#include "bvh/primitive_numbers.h"
#include "core/unset_vector.h"
#include "device_scene/collect_primitives.h"
#include "device_scene/geometry_tree.h"
#include "promin/math.h"
#include "scene/world_scene.h"
#include "shared/layout.h"

// A tree of two levels. Node 0 is the root of the upper level. Then follow the nodes of the scene's own primitives, the
// nodes of each mesh that instances share, the other nodes of the upper level with some space, and the records of the
// instances (layout.h). The leaves of the upper level are the subtrees of the scene's own primitives, and instances.
// The references of the scene's own primitives come before those of the meshes. If instances move, only the root and
// everything from the other nodes of the upper level on changes.
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

/// Replaces the binary tree of a mesh by its top boxes.
void keep_top_boxes(GeometryTree& tree);

/// Packs a mesh that was collected alone, with its tree, which has its top boxes.
PackedMesh pack_mesh(Collected collected, GeometryTree tree);

/// The input of an UpperLevel.
struct TwoLevels {
  const world::Scene& scene;
  /// The tree of the scene's own primitives, which may be empty.
  const Bvh& own;
  /// The bounds of the scene's own primitives.
  Bounds own_bounds;
  /// The number of references of `own`.
  uint32_t own_reference_count = 0;
  /// The meshes of the scene, in order.
  std::span<const PackedMesh> meshes;
  /// The number of the first primitive of each object.
  std::span<const uint32_t> first_order;
};

/// The nodes that change if instances move.
struct UpperNodes {
  layout::Node root = {};
  /// The other nodes of the upper level. The first has the index UpperLevel::first_node().
  UnsetVector<layout::Node> nodes;
  /// The indices of the instances in the order of their records (UpperLevel::put_records). The first record has the
  /// index `first_record`.
  std::vector<uint32_t> order;
  uint32_t first_record = 0;
  size_t record_count() const { return order.size() * layout::INSTANCE_RECORDS; }
  /// The number of entries that the traversal stack needs for both levels.
  uint32_t stack_size = 1;
  /// The bounds of the whole tree, not the smallest ones.
  Bounds bounds;
  /// The depth and the cost of the upper level. The scene's own primitives count as one leaf for each subtree.
  BvhStats stats;
};

/// The upper level of a tree with instances, and the data from which it is built again after instances have moved. It
/// depends only on the transforms, and not on earlier ones.
class UpperLevel {
 public:
  explicit UpperLevel(const TwoLevels& input, const BuildOptions& options = {});

  /// Builds the nodes for the current transforms.
  UpperNodes build(const BuildOptions& options = {});
  /// Returns all nodes of both levels, without the records. Call it once, with the input of the constructor.
  UnsetVector<layout::Node> join(const TwoLevels& input, const UpperNodes& upper);

  /// Writes the records of instances (UpperNodes::order), which fill `records`.
  void put_records(std::span<const uint32_t> order, std::span<layout::Node> records,
                   const BuildOptions& options = {}) const;
  UnsetVector<layout::Node> make_records(std::span<const uint32_t> order) const;

  /// Replaces the transforms of different objects. Objects that are not instances, or whose mesh no ray can hit, are
  /// ignored.
  void move(std::span<const std::pair<uint32_t, dmat4>> world_from_object, const BuildOptions& options = {});
  void move(std::span<const world::Instance> instances, const BuildOptions& options = {});

  /// Frees the data of the instances. Only restore() may be called next.
  void forget();
  /// Returns whether the data of the instances must be restored before any other call.
  bool is_forgotten() const { return is_forgotten_; }
  /// Restores the data of the instances from their records. `first_order` is that of TwoLevels.
  void restore(std::span<const layout::Node> records, std::span<const uint32_t> first_order,
               const BuildOptions& options = {});

  uint32_t first_node() const { return first_node_; }
  /// Returns the index of the root of a mesh's tree.
  uint32_t root_of(size_t mesh) const { return meshes_[mesh].root; }
  /// Returns the number of instances that a ray can hit.
  size_t instance_count() const { return instances_.size(); }
  /// Returns the bounds of the mesh of an object; empty if it is not an instance or if no ray can hit its mesh.
  Bounds mesh_box(uint32_t object) const {
    const size_t i = find(object);
    return i < instances_.size() ? meshes_[instances_[i].source.mesh].box : Bounds();
  }

 private:
  /// The parts of a mesh on which the boxes and the records of its instances depend.
  struct SharedMesh {
    Bounds box;
    std::vector<Bounds> top_boxes;
    uint32_t root = 0;
  };
  struct PlacedInstance {
    world::Instance source;
    /// The number of its first primitive.
    uint32_t first_order;
    /// The material of all triangles, or NO_INSTANCE_MATERIAL.
    uint32_t material;
    /// A box that contains the instance.
    Bounds box;
  };
  /// The records of an instance, as layout.h describes them.
  using Records = std::array<layout::Node, layout::INSTANCE_RECORDS>;
  static_assert(layout::INSTANCE_RECORDS == 2);
  Records records_of(const PlacedInstance& instance) const;

  void place(PlacedInstance& instance, const world::InstanceMap& map) const;
  void move(uint32_t object, const world::InstanceMap& map);
  /// Returns a box that contains an instance. It does not depend on the tree of the mesh, because the bits of t depend
  /// on it.
  Bounds outer_box(const PlacedInstance& instance) const;
  void collect_own(const TwoLevels& input);
  /// Returns the index of an object's instance; instance_count() for an object without an instance.
  size_t find(uint32_t object) const;

  std::vector<SharedMesh> meshes_;
  /// The instances that a ray can hit, in the order of their objects.
  UnsetVector<PlacedInstance> instances_;
  bool is_forgotten_ = false;
  Bounds own_bounds_;
  /// The subtrees of the scene's own primitives: their boxes, and the words of the nodes that contain them.
  std::vector<Bounds> own_boxes_;
  std::vector<uint32_t> own_words_;
  /// Their nodes, until join().
  UnsetVector<layout::Node> own_nodes_;
  /// The largest stack of a subtree or of a mesh.
  uint32_t lower_stack_ = 1;
  uint32_t first_node_ = 1;
  /// The number of nodes of the upper level for which there is space, without the root.
  uint32_t capacity_ = 0;
};

}  // namespace promin
