// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "bvh/builder.h"
#include "bvh/tree_view.h"
#include "promin/math.h"
#include "shared/layout.h"

// Functions that read the data of pack_tree and pack_scene on the host, in the same way as the shaders, for checks,
// tests and builders.
namespace promin {

/// A box in double. By default it is unbounded.
struct ExactBounds {
  dvec3 lo{-std::numeric_limits<double>::infinity()};
  dvec3 hi{std::numeric_limits<double>::infinity()};
};

enum class ChildKind { kAbsent, kNode, kLeaf };

struct NodeChild {
  ChildKind kind = ChildKind::kAbsent;
  /// For an inner child the index of its node; for a leaf the index of its first reference.
  uint32_t first = 0;
  /// Number of references in a leaf.
  uint32_t count = 0;
};

/// Returns the number of children that a node declares: at most NODE_WIDTH, unless the bits are not those of a node.
uint32_t child_count(const layout::Node& node);

/// Returns child 0...NODE_WIDTH - 1. Children from child_count() on are absent.
NodeChild child_of(const layout::Node& node, uint32_t child);

/// Returns the box of an existing child. If the bits are not a box (NaN, infinity), the result contains them unchanged.
ExactBounds child_box(const layout::Node& node, uint32_t child);

/// Returns the bounds of a primitive of any kind that a tree may contain. They are as conservative as bounds_of() for
/// its shape.
Bounds primitive_bounds(const layout::Primitive& primitive);

/// Returns the corners of a primitive of KIND_TRIANGLE.
std::array<vec3, 3> triangle_corners(const layout::Primitive& primitive);

/// Returns a binary tree with the leaves and the references of a packed tree. Its boxes are those of the packed nodes,
/// rounded outwards, so they may be larger than those of the tree that was packed.
Bvh unpack_tree(const TreeView& tree);

}  // namespace promin
