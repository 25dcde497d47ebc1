// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/primitive_numbers.h"

#include <algorithm>
#include <cassert>
#include <span>

namespace promin {
namespace {

/// Returns the last part whose number is at most `order`; null if there is none.
const PackedPart* find_part(std::span<const PackedPart> parts, uint32_t order) {
  const auto next = std::upper_bound(parts.begin(), parts.end(), order,
                                     [](uint32_t number, const PackedPart& part) { return number < part.order; });
  return next == parts.begin() ? nullptr : &*(next - 1);
}

/// The parts that an object's numbers refer to, and the number at which they begin to count.
struct PartsOfObject {
  std::span<const PackedPart> parts;
  uint32_t first = 0;
};

PartsOfObject find_parts(const PrimitiveNumbers& numbers, uint32_t object) {
  const bool is_instance =
      object < numbers.mesh_of_object.size() && numbers.mesh_of_object[object] != PrimitiveNumbers::kNoMesh;
  if (!is_instance) return {numbers.parts, 0};
  return {numbers.mesh_parts[numbers.mesh_of_object[object]], numbers.first_order[object]};
}

}  // namespace

PrimitiveId primitive_of_order(const PrimitiveNumbers& numbers, uint32_t order) {
  // Returns the last object that begins at or before the number. An object without primitives begins at the same number
  // as the next one.
  const auto next = std::upper_bound(numbers.first_order.begin(), numbers.first_order.end(), order);
  assert(next != numbers.first_order.begin() && next != numbers.first_order.end());
  const auto object = static_cast<uint32_t>(next - numbers.first_order.begin()) - 1;
  const uint32_t first = *(next - 1);
  const PartsOfObject of_object = find_parts(numbers, object);
  const auto further_parts = [&](uint32_t number) {
    const PackedPart* part = find_part(of_object.parts, number - of_object.first);
    return part == nullptr ? 0 : part->further_parts;
  };
  return {object, order - first - (further_parts(order) - further_parts(first))};
}

vec2 weights_of_triangle(const PrimitiveNumbers& numbers, uint32_t order, uint32_t object, const vec2& weights) {
  vec2 whole = weights;
  const PartsOfObject of_object = find_parts(numbers, object);
  const uint32_t number = order - of_object.first;
  if (const PackedPart* part = find_part(of_object.parts, number); part != nullptr && part->order == number) {
    whole = part->weights[0] + weights.x * (part->weights[1] - part->weights[0]) +
            weights.y * (part->weights[2] - part->weights[0]);
  }
  return numbers.is_rewound.at(object) ? vec2(whole.y, whole.x) : whole;
}

}  // namespace promin
