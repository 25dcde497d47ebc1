// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_instances.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>
#include <utility>

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
/// Marks references of the upper level to instances and subtrees while it is built.
constexpr uint32_t kInstanceBit = CHILD_IS_INSTANCE & ~CHILD_IS_LEAF;
/// Marks references to subtrees of the scene's own primitives. No instance has so large an index, because its records
/// would not fit into the indices of nodes.
constexpr uint32_t kOwnBit = (CHILD_INSTANCE_INDEX + 1) >> 1;
/// The space for further nodes of the upper level, as a share of those that it has.
constexpr uint32_t kSpareShare = 8;

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

/// Divides the leaves of a binary tree until each has one reference. References [first, first + count) become leaves
/// that start at the words of these references.
void divide_leaves(Bvh& bvh, std::span<const Bounds> boxes, std::span<const uint32_t> words) {
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode node = bvh.nodes[i];
    if (node.count == 0) continue;
    if (node.count == 1) {
      bvh.nodes[i].first = words[node.first];
      continue;
    }
    const uint32_t half = node.count / 2;
    const auto make = [&](uint32_t first, uint32_t count) {
      BvhNode child{{}, first, count};
      for (uint32_t k = first; k < first + count; ++k) child.bounds.extend(boxes[bvh.references[k]]);
      bvh.nodes.push_back(child);
    };
    bvh.nodes[i].first = static_cast<uint32_t>(bvh.nodes.size());
    bvh.nodes[i].count = 0;
    make(node.first, half);
    make(node.first + half, node.count - half);
  }
}

/// Returns the tree below a node.
Bvh copy_subtree(const Bvh& bvh, uint32_t root) {
  Bvh copy;
  copy.nodes.push_back(bvh.nodes[root]);
  for (size_t i = 0; i < copy.nodes.size(); ++i) {
    if (copy.nodes[i].count > 0) continue;
    const uint32_t first = copy.nodes[i].first;
    copy.nodes[i].first = static_cast<uint32_t>(copy.nodes.size());
    copy.nodes.push_back(bvh.nodes[first]);
    copy.nodes.push_back(bvh.nodes[first + 1]);
  }
  return copy;
}

/// Adds offsets to the words of a node's children: to indices of nodes and to references of leaves.
void shift_children(Node& node, uint32_t nodes, uint32_t references) {
  for (int k = 0; k < static_cast<int>(child_count(node)); ++k) {
    node.children[k] += (node.children[k] & CHILD_IS_LEAF) == 0 ? nodes : references;
  }
}

float largest_component(const dvec3& v) {
  return round_up(std::max({v.x, v.y, v.z}));
}

/// Returns a row of a matrix and another word.
uvec4 row_of(const glm::mat3& matrix, int row, uint32_t last) {
  return {word_of(matrix[0][row]), word_of(matrix[1][row]), word_of(matrix[2][row]), last};
}

/// Returns the transform of an instance that its first record contains.
world::InstanceMap map_of_record(const Node& record) {
  const std::array<uvec4, 3> rows = {record.frame, record.lo, record.hi};
  world::InstanceMap map;
  for (int row = 0; row < 3; ++row) {
    const uvec4& words = rows[static_cast<size_t>(row)];
    for (int column = 0; column < 3; ++column) {
      map.object_from_world[column][row] = std::bit_cast<float>(words[column]);
    }
    map.origin[row] = std::bit_cast<float>(words.w);
  }
  return map;
}

}  // namespace

void keep_top_boxes(GeometryTree& tree) {
  const size_t count = std::clamp<size_t>(tree.primitive_count / kTrianglesPerBox, 1, kMostTopBoxes);
  for (const uint32_t node : find_top(tree.binary, count)) tree.top_boxes.push_back(tree.binary.nodes[node].bounds);
  tree.binary = {};
}

PackedMesh pack_mesh(Collected collected, GeometryTree tree) {
  PackedMesh mesh;
  mesh.number_count = collected.order;
  mesh.bounded_count = static_cast<uint32_t>(collected.bounded.size());
  mesh.degenerate_count = collected.degenerate_count;
  mesh.parts = std::move(collected.numbers.parts);
  mesh.vertices = std::move(collected.vertices);
  mesh.bvh = std::move(tree.stats);
  mesh.nodes = std::move(tree.nodes);
  mesh.stack_size = tree.stack_size;
  mesh.primitives.resize(tree.references.size());
  mesh.surfaces.resize(tree.references.size());
  for (size_t i = 0; i < tree.references.size(); ++i) {
    mesh.primitives[i] = collected.bounded[tree.references[i]];
    mesh.surfaces[i] = collected.bounded_surfaces[tree.references[i]];
  }
  mesh.top_boxes = std::move(tree.top_boxes);
  for (const Bounds& box : collected.boxes) mesh.box.extend(box);
  return mesh;
}

UpperLevel::UpperLevel(const TwoLevels& input, const BuildOptions& options) : own_bounds_(input.own_bounds) {
  collect_own(input);
  auto next = static_cast<uint32_t>(1 + own_nodes_.size());
  for (const PackedMesh& mesh : input.meshes) {
    meshes_.push_back({mesh.box, mesh.top_boxes, next});
    next += static_cast<uint32_t>(mesh.nodes.size());
    lower_stack_ = std::max(lower_stack_, mesh.stack_size);
  }
  first_node_ = next;
  std::vector<uint32_t> shown;
  for (uint32_t i = 0; i < input.scene.instances.size(); ++i) {
    if (!meshes_[input.scene.instances[i].mesh].top_boxes.empty()) shown.push_back(i);
  }
  instances_.resize(shown.size());
  for_each_chunk(shown.size(), kInstanceChunk, options.thread_count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const world::Instance& source = input.scene.instances[shown[i]];
      PlacedInstance& instance = instances_[i];
      instance.source = source;
      const bool has_own = !input.scene.meshes[source.mesh].triangle_materials.empty();
      instance.first_order = input.first_order[source.object];
      instance.material = has_own ? NO_INSTANCE_MATERIAL : input.scene.objects[source.object].material;
      place(instance, source.map);
    }
  });
}

/// Sets everything that depends on the transform.
void UpperLevel::place(PlacedInstance& instance, const world::InstanceMap& map) const {
  instance.source.map = map;
  instance.box = world::bounds_of(map, meshes_[instance.source.mesh].top_boxes);
}

Bounds UpperLevel::outer_box(const PlacedInstance& instance) const {
  return world::bounds_of(instance.source.map, {&meshes_[instance.source.mesh].box, 1});
}

UpperLevel::Records UpperLevel::records_of(const PlacedInstance& instance) const {
  const SharedMesh& mesh = meshes_[instance.source.mesh];
  const world::InstanceMap& map = instance.source.map;
  const Bounds outer = outer_box(instance);
  const float radius = largest_component(glm::max(glm::abs(dvec3(mesh.box.lo)), glm::abs(dvec3(mesh.box.hi))));
  const dvec3 origin(map.origin);
  const float world_radius = largest_component(glm::max(dvec3(outer.hi) - origin, origin - dvec3(outer.lo)));
  const glm::mat3& turn = map.object_from_world;
  Records records{};
  Node& to_object = records[0];
  to_object.frame = row_of(turn, 0, word_of(map.origin.x));
  to_object.lo = row_of(turn, 1, word_of(map.origin.y));
  to_object.hi = row_of(turn, 2, word_of(map.origin.z));
  to_object.children = uvec4(word_of(radius), mesh.root, instance.first_order, word_of(world_radius));
  // E, the inverse of R.
  const glm::mat3 back(glm::inverse(dmat3(turn)));
  Node& to_world = records[1];
  to_world.frame = row_of(back, 0, instance.material);
  const bool is_mirrored = glm::determinant(dmat3(turn)) < 0.0;
  const uint32_t hash = hashes_of(instance.source.object, 0) & INSTANCE_HASH_MASK;
  to_world.lo = row_of(back, 1, hash | (is_mirrored ? INSTANCE_IS_MIRRORED : 0U));
  to_world.hi = row_of(back, 2, 0);
  return records;
}

void UpperLevel::put_records(std::span<const uint32_t> order, std::span<Node> records,
                             const BuildOptions& options) const {
  for_each_chunk(order.size(), kInstanceChunk, options.thread_count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      std::ranges::copy(records_of(instances_[order[i]]), records.begin() + static_cast<std::ptrdiff_t>(2 * i));
    }
  });
}

UnsetVector<Node> UpperLevel::make_records(std::span<const uint32_t> order) const {
  UnsetVector<Node> records;
  records.resize(order.size() * INSTANCE_RECORDS);
  put_records(order, records);
  return records;
}

/// Packs the subtrees of the scene's own primitives, each by itself, so that they stay when instances move.
void UpperLevel::collect_own(const TwoLevels& input) {
  for (const uint32_t node : find_top(input.own, kMostOwnSubtrees)) {
    own_boxes_.push_back(input.own.nodes[node].bounds);
    PackedTree subtree = pack_tree(copy_subtree(input.own, node));
    if (input.own.nodes[node].count > 0) {
      own_words_.push_back(subtree.nodes.front().children.x);
      continue;
    }
    const auto first = static_cast<uint32_t>(1 + own_nodes_.size());
    own_words_.push_back(first);
    lower_stack_ = std::max(lower_stack_, subtree.stack_size);
    for (Node& each : subtree.nodes) {
      shift_children(each, first, 0);
      own_nodes_.push_back(each);
    }
  }
}

UpperNodes UpperLevel::build(const BuildOptions& options) {
  const size_t count = instances_.size();
  UnsetVector<Bounds> boxes;
  boxes.resize(count + own_boxes_.size());
  UpperNodes upper;
  upper.bounds = own_bounds_;
  const auto take_boxes = [&](size_t begin, size_t end, Bounds& outer) {
    for (size_t i = begin; i < end; ++i) {
      boxes[i] = instances_[i].box;
      outer.extend(outer_box(instances_[i]));
    }
  };
  for (const Bounds& outer : make_parts(count, kInstanceChunk, options.thread_count, Bounds(), take_boxes)) {
    upper.bounds.extend(outer);
  }
  std::ranges::copy(own_boxes_, boxes.begin() + static_cast<std::ptrdiff_t>(count));
  Bvh bvh = build_bvh("sah", {boxes}, options);
  // The records are in the order of the leaves, because neighbours are read together.
  std::vector<uint32_t> words;
  words.reserve(bvh.references.size());
  upper.order.reserve(count);
  for (const uint32_t reference : bvh.references) {
    if (reference >= count) {
      words.push_back(kInstanceBit | kOwnBit | (reference - static_cast<uint32_t>(count)));
      continue;
    }
    words.push_back(kInstanceBit | static_cast<uint32_t>(upper.order.size()));
    upper.order.push_back(reference);
  }
  divide_leaves(bvh, boxes, words);
  upper.stats = measure_bvh("sah", bvh);
  PackedTree packed = pack_tree(bvh);
  upper.stack_size = packed.stack_size + lower_stack_ + 1;
  const auto needed = static_cast<uint32_t>(packed.nodes.size() - 1);
  if (needed > capacity_) capacity_ = needed + needed / kSpareShare;
  upper.first_record = first_node_ + capacity_;
  for (Node& node : packed.nodes) {
    for (int k = 0; k < static_cast<int>(child_count(node)); ++k) {
      uint32_t& child = node.children[k];
      if ((child & CHILD_INSTANCE_MASK) != CHILD_IS_INSTANCE) {
        child += first_node_ - 1;
      } else if ((child & kOwnBit) != 0) {
        child = own_words_[child & (kOwnBit - 1)];
      } else {
        child = CHILD_IS_INSTANCE | (upper.first_record + INSTANCE_RECORDS * (child & CHILD_INSTANCE_INDEX));
      }
    }
  }
  upper.root = packed.nodes.front();
  upper.nodes.assign(packed.nodes.begin() + 1, packed.nodes.end());
  return upper;
}

UnsetVector<Node> UpperLevel::join(const TwoLevels& input, const UpperNodes& upper) {
  UnsetVector<Node> nodes;
  nodes.resize(upper.first_record);
  nodes[0] = upper.root;
  std::ranges::copy(own_nodes_, nodes.begin() + 1);
  std::exchange(own_nodes_, {});
  uint32_t reference = input.own_reference_count;
  for (size_t i = 0; i < meshes_.size(); ++i) {
    const UnsetVector<Node>& below = input.meshes[i].nodes;
    for (size_t k = 0; k < below.size(); ++k) {
      Node& node = nodes[meshes_[i].root + k];
      node = below[k];
      shift_children(node, meshes_[i].root, reference);
    }
    reference += static_cast<uint32_t>(input.meshes[i].primitives.size());
  }
  std::ranges::copy(upper.nodes, nodes.begin() + first_node_);
  std::fill(nodes.begin() + first_node_ + static_cast<std::ptrdiff_t>(upper.nodes.size()), nodes.end(), Node{});
  return nodes;
}

void UpperLevel::move(std::span<const std::pair<uint32_t, dmat4>> world_from_object, const BuildOptions& options) {
  for_each_chunk(world_from_object.size(), kInstanceChunk, options.thread_count, [&](size_t begin, size_t end) {
    for (const auto& [object, transform] : world_from_object.subspan(begin, end - begin)) {
      move(object, world::map_of(transform));
    }
  });
}

void UpperLevel::move(std::span<const world::Instance> instances, const BuildOptions& options) {
  for_each_chunk(instances.size(), kInstanceChunk, options.thread_count, [&](size_t begin, size_t end) {
    for (const world::Instance& instance : instances.subspan(begin, end - begin)) move(instance.object, instance.map);
  });
}

void UpperLevel::move(uint32_t object, const world::InstanceMap& map) {
  const size_t i = find(object);
  if (i < instances_.size()) place(instances_[i], map);
}

void UpperLevel::forget() {
  std::exchange(instances_, {});
  is_forgotten_ = true;
}

void UpperLevel::restore(std::span<const Node> records, std::span<const uint32_t> first_order,
                         const BuildOptions& options) {
  instances_.resize(records.size() / INSTANCE_RECORDS);
  for_each_chunk(instances_.size(), kInstanceChunk, options.thread_count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Node& to_object = records[INSTANCE_RECORDS * i];
      PlacedInstance& instance = instances_[i];
      instance.first_order = to_object.children.z;
      instance.material = records[INSTANCE_RECORDS * i + 1].frame.w;
      // The last of the objects that begin with this number has the primitives.
      const auto next = std::ranges::upper_bound(first_order, instance.first_order);
      instance.source.object = static_cast<uint32_t>(next - first_order.begin()) - 1;
      const auto mesh = std::ranges::lower_bound(meshes_, to_object.children.y, {}, &SharedMesh::root);
      instance.source.mesh = static_cast<uint32_t>(mesh - meshes_.begin());
      place(instance, map_of_record(to_object));
    }
  });
  std::ranges::sort(instances_, {}, [](const PlacedInstance& instance) { return instance.source.object; });
  is_forgotten_ = false;
}

size_t UpperLevel::find(uint32_t object) const {
  const auto object_of = [](const PlacedInstance& instance) { return instance.source.object; };
  const auto found = std::ranges::lower_bound(instances_, object, {}, object_of);
  return found == instances_.end() || object_of(*found) != object ? instances_.size()
                                                                  : static_cast<size_t>(found - instances_.begin());
}

}  // namespace promin
