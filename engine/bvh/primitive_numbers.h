// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "promin/math.h"

namespace promin {

/// One of the parts into which a triangle is packed (device_scene/cut_triangles.h).
struct PackedPart {
  uint32_t order = 0;
  /// Number of parts, counted over all triangles up to and including this part, that are not the first part of their
  /// triangle.
  uint32_t further_parts = 0;
  /// The weights of the triangle's second and third corner, at each of the part's three corners.
  std::array<vec2, 3> weights{};
};

/// Converts the numbers of primitives to objects and primitives. The numbers count primitives in (object, primitive)
/// order. They are in Primitive::c.y, where those of an instance's mesh begin at 0.
struct PrimitiveNumbers {
  /// The value of `mesh_of_object` for an object that is not an instance.
  static constexpr uint32_t kNoMesh = ~0U;

  /// The number of each object's first primitive; then the number of all primitives.
  std::vector<uint32_t> first_order;
  /// For each object, whether it is a mesh whose second and third corners were exchanged when it was moved to the world
  /// (world::Object::is_rewound).
  std::vector<bool> is_rewound;
  /// The parts of all triangles that have more than one part, sorted by the triangles' order.
  std::vector<PackedPart> parts;
  /// For each mesh that instances share, the parts of its triangles, with numbers that begin at 0.
  std::vector<std::vector<PackedPart>> mesh_parts = {};
  /// For each object, the index in `mesh_parts` if it is an instance; empty if no object is one.
  std::vector<uint32_t> mesh_of_object = {};
  /// True if there are more primitives than numbers. Then all primitives of an instance have one number, and count as
  /// primitive 0.
  bool are_instances_whole = false;
};

/// The object and the primitive that have a number.
struct PrimitiveId {
  uint32_t object = 0;
  uint32_t primitive = 0;
};
PrimitiveId primitive_of_order(const PrimitiveNumbers& numbers, uint32_t order);

/// Converts weights: from those of a packed part's second and third corner to those of the whole triangle in its object
/// (primitive_of_order).
vec2 weights_of_triangle(const PrimitiveNumbers& numbers, uint32_t order, uint32_t object, const vec2& weights);

}  // namespace promin
