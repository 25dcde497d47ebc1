// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/read_node.h"

#include <bit>

#include "shapes/shapes.h"

namespace promin {
namespace {

uint32_t byte_of(uint32_t word, uint32_t index) {
  return (word >> (8 * index)) & 0xFF;
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

}  // namespace promin
