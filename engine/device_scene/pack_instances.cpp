// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_instances.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>
#include <utility>

#include "bvh/clip_triangle.h"
#include "bvh/pack_tree.h"
#include "bvh/read_node.h"
#include "core/parallel.h"
#include "core/rounding.h"

namespace promin {
namespace {

using namespace layout;

/// The most boxes of a mesh from which the box of an instance is computed, and the number of triangles for each.
constexpr size_t kMostTopBoxes = 32;
constexpr size_t kTrianglesPerBox = 16;
/// The most subtrees of the scene's own tree that are leaves of the upper level.
constexpr size_t kMostOwnSubtrees = 256;
constexpr size_t kInstanceChunk = 256;
/// Marks references of the upper level to instances while it is built.
constexpr uint32_t kInstanceBit = CHILD_IS_INSTANCE & ~CHILD_IS_LEAF;

uint32_t word_of(float value) {
  return std::bit_cast<uint32_t>(value);
}

/// Opens the largest inner nodes of a binary tree until there are `most` subtrees. Returns their roots.
std::vector<uint32_t> find_top(const Bvh& bvh, size_t most) {
  if (bvh.nodes.empty()) return {};
  const auto is_smaller = [&](uint32_t a, uint32_t b) {
    return std::pair(bvh.nodes[a].bounds.half_area(), b) < std::pair(bvh.nodes[b].bounds.half_area(), a);
  };
  std::priority_queue<uint32_t, std::vector<uint32_t>, decltype(is_smaller)> open(is_smaller);
  std::vector<uint32_t> top;
  const auto add = [&](uint32_t node) {
    if (bvh.nodes[node].count > 0) {
      top.push_back(node);
    } else {
      open.push(node);
    }
  };
  add(0);
  while (!open.empty() && top.size() + open.size() < most) {
    const uint32_t node = open.top();
    open.pop();
    add(bvh.nodes[node].first);
    add(bvh.nodes[node].first + 1);
  }
  for (; !open.empty(); open.pop()) top.push_back(open.top());
  return top;
}

/// Makes the binary tree of the upper level: each leaf has a leaf of the scene's own tree, or one instance.
class UpperLevel {
 public:
  UpperLevel(const TwoLevels& input, std::span<const Bounds> boxes, const BuildOptions& options)
      : own_(input.own), boxes_(boxes.begin(), boxes.end()), instance_count_(boxes.size()) {
    own_subtrees_ = find_top(own_, kMostOwnSubtrees);
    for (const uint32_t node : own_subtrees_) boxes_.push_back(own_.nodes[node].bounds);
    top_ = build_bvh("sah", {boxes_}, options);
    result_.references = own_.references;
    if (top_.nodes.empty()) return;
    result_.nodes.emplace_back();
    open_.push_back({0, Source::kTop, 0, 0, 0});
    while (!open_.empty()) {
      const Open next = open_.back();
      open_.pop_back();
      make(next);
    }
  }

  Bvh take() { return std::move(result_); }
  /// The instances in the order of leaves.
  const std::vector<uint32_t>& order() const { return order_; }

 private:
  enum class Source { kTop, kPart, kOwn };
  /// A node that must still be made from a node of a tree, or from a part of a leaf of the top.
  struct Open {
    uint32_t target;
    Source source;
    uint32_t node;
    uint32_t first;
    uint32_t count;
  };

  void make(const Open& open) {
    switch (open.source) {
      case Source::kTop: {
        const BvhNode& node = top_.nodes[open.node];
        if (node.count > 0) return make_part(open.target, node.first, node.count);
        make_inner(open.target, node.bounds, {0, Source::kTop, node.first, 0, 0},
                   {0, Source::kTop, node.first + 1, 0, 0});
        return;
      }
      case Source::kPart:
        return make_part(open.target, open.first, open.count);
      case Source::kOwn: {
        const BvhNode& node = own_.nodes[open.node];
        if (node.count > 0) {
          result_.nodes[open.target] = node;
          return;
        }
        make_inner(open.target, node.bounds, {0, Source::kOwn, node.first, 0, 0},
                   {0, Source::kOwn, node.first + 1, 0, 0});
        return;
      }
    }
  }

  /// Makes a node of references of the top.
  void make_part(uint32_t target, uint32_t first, uint32_t count) {
    if (count == 1) return make_single(target, top_.references[first]);
    Bounds box;
    for (uint32_t i = first; i < first + count; ++i) box.extend(boxes_[top_.references[i]]);
    const uint32_t half = count / 2;
    make_inner(target, box, {0, Source::kPart, 0, first, half}, {0, Source::kPart, 0, first + half, count - half});
  }

  void make_single(uint32_t target, uint32_t reference) {
    if (reference >= instance_count_)
      return make({target, Source::kOwn, own_subtrees_[reference - instance_count_], 0, 0});
    result_.nodes[target] = {boxes_[reference], kInstanceBit | static_cast<uint32_t>(order_.size()), 1};
    order_.push_back(reference);
  }

  void make_inner(uint32_t target, const Bounds& box, Open a, Open b) {
    const auto first = static_cast<uint32_t>(result_.nodes.size());
    result_.nodes.emplace_back();
    result_.nodes.emplace_back();
    result_.nodes[target] = {box, first, 0};
    a.target = first;
    b.target = first + 1;
    open_.push_back(b);
    open_.push_back(a);
  }

  const Bvh& own_;
  UnsetVector<Bounds> boxes_;
  size_t instance_count_;
  std::vector<uint32_t> own_subtrees_;
  Bvh top_;
  Bvh result_;
  std::vector<Open> open_;
  std::vector<uint32_t> order_;
};

/// Copies the nodes of a mesh behind all others. Returns the index of its root.
uint32_t append_nodes(const PackedMesh& mesh, uint32_t first_reference, UnsetVector<Node>& nodes, size_t first) {
  for (size_t i = 0; i < mesh.nodes.size(); ++i) {
    Node node = mesh.nodes[i];
    for (int k = 0; k < static_cast<int>(child_count(node)); ++k) {
      node.children[k] += (node.children[k] & CHILD_IS_LEAF) == 0 ? static_cast<uint32_t>(first) : first_reference;
    }
    nodes[first + i] = node;
  }
  return static_cast<uint32_t>(first);
}

float largest_component(const dvec3& v) {
  return round_up(std::max({v.x, v.y, v.z}));
}

/// Writes the two records of an instance. Its radii do not depend on the tree, because the bits of t depend on them.
void write_records(const world::InstanceMap& map, const PackedMesh& mesh, uint32_t root, uint32_t first_order,
                   uint32_t material, uint32_t object, Node* records) {
  const float radius = largest_component(glm::max(glm::abs(dvec3(mesh.box.lo)), glm::abs(dvec3(mesh.box.hi))));
  const Bounds box = world::bounds_of(map, {&mesh.box, 1});
  const dvec3 origin(map.origin);
  const float world_radius = largest_component(glm::max(dvec3(box.hi) - origin, origin - dvec3(box.lo)));
  const auto row = [](const glm::mat3& matrix, int i, uint32_t last) {
    return uvec4(word_of(matrix[0][i]), word_of(matrix[1][i]), word_of(matrix[2][i]), last);
  };
  const glm::mat3& turn = map.object_from_world;
  records[0] = {row(turn, 0, word_of(map.origin.x)), row(turn, 1, word_of(map.origin.y)),
                row(turn, 2, word_of(map.origin.z)), uvec4(word_of(radius), root, first_order, word_of(world_radius))};
  uint32_t bits = hashes_of(object, 0) & INSTANCE_HASH_MASK;
  if (glm::determinant(dmat3(turn)) < 0.0) bits |= INSTANCE_IS_MIRRORED;
  const glm::mat3& back = map.world_from_object;
  records[1] = {row(back, 0, material), row(back, 1, bits), row(back, 2, 0), uvec4(0)};
}

}  // namespace

PackedMesh pack_mesh(const world::Scene& scene, std::string_view builder, const BuildOptions& options) {
  Collected collected = collect_primitives(scene);
  PackedMesh mesh;
  mesh.number_count = collected.order;
  mesh.bounded_count = static_cast<uint32_t>(collected.bounded.size());
  mesh.degenerate_count = collected.degenerate_count;
  mesh.parts = std::move(collected.numbers.parts);
  mesh.vertices = std::move(collected.vertices);
  const Bvh bvh = build_bvh(builder,
                            {collected.boxes,
                             [&](uint32_t primitive, const Bounds& window) {
                               return clip_triangle(triangle_corners(collected.bounded[primitive]), window);
                             }},
                            options);
  mesh.bvh = measure_bvh(builder, bvh);
  PackedTree tree = pack_tree(bvh);
  mesh.nodes = std::move(tree.nodes);
  mesh.stack_size = tree.stack_size;
  mesh.primitives.resize(bvh.references.size());
  mesh.surfaces.resize(bvh.references.size());
  for (size_t i = 0; i < bvh.references.size(); ++i) {
    mesh.primitives[i] = collected.bounded[bvh.references[i]];
    mesh.surfaces[i] = collected.bounded_surfaces[bvh.references[i]];
  }
  const size_t box_count = std::clamp<size_t>(collected.bounded.size() / kTrianglesPerBox, 1, kMostTopBoxes);
  for (const uint32_t node : find_top(bvh, box_count)) mesh.top_boxes.push_back(bvh.nodes[node].bounds);
  for (const Bounds& box : collected.boxes) mesh.box.extend(box);
  return mesh;
}

TwoLevelTree build_two_levels(const TwoLevels& input, const BuildOptions& options) {
  std::vector<uint32_t> shown;
  for (uint32_t i = 0; i < input.scene.instances.size(); ++i) {
    if (!input.meshes[input.scene.instances[i].mesh].top_boxes.empty()) shown.push_back(i);
  }
  UnsetVector<Bounds> boxes;
  boxes.resize(shown.size());
  for_each_chunk(shown.size(), kInstanceChunk, options.thread_count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const world::Instance& instance = input.scene.instances[shown[i]];
      boxes[i] = world::bounds_of(world::map_of(instance), input.meshes[instance.mesh].top_boxes);
    }
  });
  TwoLevelTree tree;
  // Like the radii, these bounds do not depend on the trees of the meshes.
  for (const Bounds& part : make_parts(shown.size(), kInstanceChunk, options.thread_count, Bounds(),
                                       [&](size_t begin, size_t end, Bounds&some) {
                                         for (size_t i = begin; i < end; ++i) {
                                           const world::Instance& instance = input.scene.instances[shown[i]];
                                           const Bounds& box = input.meshes[instance.mesh].box;
                                           some.extend(world::bounds_of(world::map_of(instance), {&box, 1}));
                                         }
                                       })) {
    tree.bounds.extend(part);
  }
  UpperLevel upper(input, boxes, options);
  const Bvh bvh = upper.take();
  tree.upper = measure_bvh("sah", bvh);
  PackedTree packed = pack_tree(bvh);

  size_t node_count = packed.nodes.size();
  uint32_t deepest = 0;
  for (const PackedMesh& mesh : input.meshes) {
    node_count += mesh.nodes.size();
    deepest = std::max(deepest, mesh.stack_size);
  }
  const auto first_record = static_cast<uint32_t>(node_count);
  tree.stack_size = packed.stack_size + deepest + 1;
  tree.node_count = first_record;
  tree.instance_count = shown.size();
  tree.nodes.resize(node_count + INSTANCE_RECORDS * shown.size());
  for (size_t i = 0; i < packed.nodes.size(); ++i) {
    Node node = packed.nodes[i];
    for (int k = 0; k < static_cast<int>(child_count(node)); ++k) {
      uint32_t& child = node.children[k];
      if ((child & CHILD_INSTANCE_MASK) != CHILD_IS_INSTANCE) continue;
      child = CHILD_IS_INSTANCE | (first_record + INSTANCE_RECORDS * (child & CHILD_INSTANCE_INDEX));
    }
    tree.nodes[i] = node;
  }
  size_t next = packed.nodes.size();
  uint32_t reference = input.own_reference_count;
  std::vector<uint32_t> roots;
  for (const PackedMesh& mesh : input.meshes) {
    roots.push_back(append_nodes(mesh, reference, tree.nodes, next));
    next += mesh.nodes.size();
    reference += static_cast<uint32_t>(mesh.primitives.size());
  }
  const std::vector<uint32_t>& order = upper.order();
  for_each_chunk(order.size(), kInstanceChunk, options.thread_count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const world::Instance& instance = input.scene.instances[shown[order[i]]];
      const bool has_own = !input.scene.meshes[instance.mesh].triangle_materials.empty();
      const uint32_t material = has_own ? NO_INSTANCE_MATERIAL : input.scene.objects[instance.object].material;
      write_records(world::map_of(instance), input.meshes[instance.mesh], roots[instance.mesh],
                    input.first_order[instance.object], material, instance.object,
                    &tree.nodes[first_record + INSTANCE_RECORDS * i]);
    }
  });
  return tree;
}

}  // namespace promin
