// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "promin/math.h"
#include "shared/layout.h"

// Host functions that read the data of pack_tree and pack_scene as the shaders do, for checks, tests and builders.
namespace promin {

/// A box in double. By default it is unbounded.
struct ExactBounds {
  dvec3 lo{-std::numeric_limits<double>::infinity()};
  dvec3 hi{std::numeric_limits<double>::infinity()};
};

enum class ChildKind { kAbsent, kNode, kLeaf };

struct NodeChild {
  ChildKind kind = ChildKind::kAbsent;
  /// The index of a node, the first reference of a leaf.
  uint32_t first = 0;
  /// References in a leaf.
  uint32_t count = 0;
};

/// Returns the number of children that a node declares: at most NODE_WIDTH, unless the bits are not those of a node.
uint32_t child_count(const layout::Node& node);

/// Child 0...NODE_WIDTH - 1; children from child_count on are absent.
NodeChild child_of(const layout::Node& node, uint32_t child);

/// Returns the box of an existing child. Bits that are not a box (NaN, infinity) are returned unchanged.
ExactBounds child_box(const layout::Node& node, uint32_t child);

/// Returns the bounds of any primitive of the tree, as conservative as bounds_of for its shape.
Bounds primitive_bounds(const layout::Primitive& primitive);

/// The corners of a primitive of KIND_TRIANGLE.
std::array<vec3, 3> triangle_corners(const layout::Primitive& primitive);

}  // namespace promin
