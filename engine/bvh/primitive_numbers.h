// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "promin/math.h"

namespace promin {

/// One of the parts that a triangle is packed as (device_scene/cut_triangles.h).
struct PackedPart {
  uint32_t order = 0;
  /// Parts up to this one, of all triangles, that are not their triangle's first.
  uint32_t further_parts = 0;
  /// The weights of the triangle's second and third corner at the part's three.
  std::array<vec2, 3> weights{};
};

/// What the numbers in Primitive::c.y stand for: they count primitives in (object, primitive) order.
struct PrimitiveNumbers {
  /// Of each object the number of its first primitive; then the number of all.
  std::vector<uint32_t> first_order;
  /// Of all triangles in more than one part, by their order.
  std::vector<PackedPart> parts;
};

/// What a primitive's number stands for.
struct PrimitiveId {
  uint32_t object = 0;
  uint32_t primitive = 0;
};
PrimitiveId primitive_of_order(const PrimitiveNumbers& numbers, uint32_t order);

/// From the weights of what was packed under a number to those of the triangle.
vec2 weights_of_triangle(const PrimitiveNumbers& numbers, uint32_t order, const vec2& weights);

}  // namespace promin
