// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/read_node.h"

#include <bit>
#include <vector>

#include "core/rounding.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

uint32_t byte_of(uint32_t word, uint32_t index) {
  return (word >> (8 * index)) & 0xFF;
}

Bounds outer_bounds(const ExactBounds& box) {
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lo[axis] = round_down(box.lo[axis]);
    bounds.hi[axis] = round_up(box.hi[axis]);
  }
  return bounds;
}

}  // namespace

uint32_t child_count(const layout::Node& node) {
  return byte_of(node.frame.w, 3);
}

NodeChild child_of(const layout::Node& node, uint32_t child) {
  if (child >= child_count(node)) return {};
  const uint32_t word = node.children[static_cast<int>(child)];
  if ((word & layout::CHILD_IS_LEAF) == 0) return {ChildKind::kNode, word, 0};
  return {ChildKind::kLeaf, word & layout::CHILD_FIRST_MASK, ((word >> layout::CHILD_COUNT_SHIFT) & 15) + 1};
}

ExactBounds child_box(const layout::Node& node, uint32_t child) {
  const uvec3 hi_words(node.lo.w, node.hi.x, node.hi.y);
  ExactBounds box;
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = std::bit_cast<float>(node.frame[axis]);
    const double step = std::bit_cast<float>(byte_of(node.frame.w, static_cast<uint32_t>(axis)) << 23);
    box.lo[axis] = origin + step * byte_of(node.lo[axis], child);
    box.hi[axis] = origin + step * byte_of(hi_words[axis], child);
  }
  return box;
}

Bounds primitive_bounds(const layout::Primitive& p) {
  switch (p.c.z) {
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  case layout::KIND_##KIND:                                          \
    return bounds_of(unpack<world::TYPE>(p));
#include "promin/kinds/primitives.def"
    case layout::KIND_TRIANGLE: {
      Bounds bounds;
      for (const vec3& corner : triangle_corners(p)) bounds.extend(corner);
      return bounds;
    }
  }
  return {};
}

std::array<vec3, 3> triangle_corners(const layout::Primitive& p) {
  return {vec3(p.a), {p.a.w, p.b.x, p.b.y}, {p.b.z, p.b.w, std::bit_cast<float>(p.c.x)}};
}

Bvh unpack_tree(const TreeView& tree) {
  Bvh bvh;
  bvh.references.assign(tree.references.begin(), tree.references.end());
  if (tree.references.empty()) return bvh;
  /// Children of a packed node, from `begin` to `end`, that become the node `target`.
  struct Open {
    uint32_t target;
    uint32_t node;
    uint32_t begin;
    uint32_t end;
  };
  std::vector<Open> open = {{0, 0, 0, child_count(tree.nodes[0])}};
  bvh.nodes.emplace_back();
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const layout::Node& node = tree.nodes[next.node];
    if (next.end - next.begin == 1) {
      const NodeChild child = child_of(node, next.begin);
      if (child.kind == ChildKind::kLeaf) {
        bvh.nodes[next.target] = {outer_bounds(child_box(node, next.begin)), child.first, child.count};
      } else {
        open.push_back({next.target, child.first, 0, child_count(tree.nodes[child.first])});
      }
      continue;
    }
    Bounds box;
    for (uint32_t i = next.begin; i < next.end; ++i) box.extend(outer_bounds(child_box(node, i)));
    const auto first = static_cast<uint32_t>(bvh.nodes.size());
    bvh.nodes.emplace_back();
    bvh.nodes.emplace_back();
    bvh.nodes[next.target] = {box, first, 0};
    const uint32_t middle = (next.begin + next.end) / 2;
    open.push_back({first + 1, next.node, middle, next.end});
    open.push_back({first, next.node, next.begin, middle});
  }
  return bvh;
}

}  // namespace promin
