// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/geometry_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "bvh/clip_triangle.h"
#include "bvh/pack_tree.h"
#include "bvh/read_node.h"
#include "core/hash.h"
#include "core/parallel.h"

namespace promin {
namespace {

using namespace layout;

/// The number of nodes whose references a thread sorts at a time.
constexpr size_t kSortChunkSize = 16384;

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
  for_each_chunk(bvh.nodes.size(), kSortChunkSize, 0, [&](size_t begin, size_t end) {
    for (const BvhNode& node : std::span(bvh.nodes).subspan(begin, end - begin)) {
      if (node.count == 0) continue;
      const auto first = references.begin() + node.first;
      if (!std::is_sorted(first, first + node.count, is_before)) std::stable_sort(first, first + node.count, is_before);
    }
  });
  return references;
}

/// Makes the boxes of a tree from a file as small as the boxes of its primitives allow. Then they are also boxes if the
/// file is a manipulated one, whose boxes may be NaN.
void shrink_boxes(Bvh& bvh, std::span<const Bounds> boxes) {
  std::vector<Bounds> exact(bvh.nodes.size());
  // The children of a node follow it.
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    BvhNode& node = bvh.nodes[i];
    if (node.count > 0) {
      for (uint32_t k = 0; k < node.count; ++k) exact[i].extend(boxes[bvh.references[node.first + k]]);
    } else {
      exact[i] = exact[node.first];
      exact[i].extend(exact[node.first + 1]);
    }
    // A leaf may have only a part of a primitive.
    Bounds common;
    for (int axis = 0; axis < 3; ++axis) {
      common.lo[axis] = std::fmax(node.bounds.lo[axis], exact[i].lo[axis]);
      common.hi[axis] = std::fmin(node.bounds.hi[axis], exact[i].hi[axis]);
    }
    node.bounds = common.is_empty() ? exact[i] : common;
  }
}

}  // namespace

TreeView GeometryTree::view() const {
  return {nodes, references, primitive_count, stack_size, kinds, geometry_hash, stats};
}

uint32_t kinds_of(const Collected& collected) {
  uint32_t kinds = 0;
  for (const Primitive& p : collected.bounded) kinds |= 1U << p.c.z;
  return kinds;
}

uint64_t hash_geometry(const Collected& collected) {
  Hash64 hash;
  hash.add(collected.bounded.size());
  for (const Primitive& p : collected.bounded) {
    const std::array words = {p.a, p.b};
    hash.add(std::as_bytes(std::span(words)));
    hash.add(p.c.x | uint64_t{p.c.z} << 32);
  }
  return hash.value();
}

GeometryTree build_geometry_tree(const Collected& collected, const world::Scene& scene, std::string_view builder,
                                 const BuildOptions& options) {
  GeometryTree tree;
  tree.binary =
      build_bvh(builder,
                {collected.boxes,
                 [&](uint32_t primitive, const Bounds& window) { return clip(collected.bounded[primitive], window); }},
                options);
  check_at_most(CHILD_FIRST_MASK, tree.binary.references.size(), scene, "the tree refers to", "parts of primitives",
                ", or use the builder sah", Setting::kBuilder);
  tree.references = sort_leaves_by_kind(tree.binary, collected.bounded);
  PackedTree packed = pack_tree(tree.binary);
  check_at_most(MAX_NODES, packed.nodes.size(), scene, "the scene's tree has", "nodes");
  tree.nodes = std::move(packed.nodes);
  tree.stack_size = packed.stack_size;
  tree.primitive_count = static_cast<uint32_t>(collected.bounded.size());
  tree.kinds = kinds_of(collected);
  tree.stats = measure_bvh(builder, tree.binary);
  tree.stats.bytes = tree.nodes.size() * sizeof(Node);
  return tree;
}

GeometryTree read_geometry_tree(const Collected& collected, const BvhFile& file) {
  const TreeView& found = file.find(hash_geometry(collected), collected.bounded.size());
  GeometryTree tree;
  tree.binary = unpack_tree(found);
  shrink_boxes(tree.binary, collected.boxes);
  tree.nodes.assign(found.nodes.begin(), found.nodes.end());
  tree.references.assign(found.references.begin(), found.references.end());
  tree.primitive_count = found.primitive_count;
  tree.stack_size = found.stack_size;
  tree.kinds = kinds_of(collected);
  tree.geometry_hash = found.geometry_hash;
  tree.stats = found.stats;
  return tree;
}

}  // namespace promin
