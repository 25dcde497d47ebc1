// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/primitive_numbers.h"

#include <algorithm>
#include <cassert>

namespace promin {
namespace {

/// Returns the last part whose number is at most `order`; null if there is none.
const PackedPart* find_part(const PrimitiveNumbers& numbers, uint32_t order) {
  const auto next = std::upper_bound(numbers.parts.begin(), numbers.parts.end(), order,
                                     [](uint32_t number, const PackedPart& part) { return number < part.order; });
  return next == numbers.parts.begin() ? nullptr : &*(next - 1);
}

}  // namespace

PrimitiveId primitive_of_order(const PrimitiveNumbers& numbers, uint32_t order) {
  // Returns the last object that begins at or before the number. An object without primitives begins at the same number
  // as the next one.
  const auto next = std::upper_bound(numbers.first_order.begin(), numbers.first_order.end(), order);
  assert(next != numbers.first_order.begin() && next != numbers.first_order.end());
  const auto further_parts = [&](uint32_t number) {
    const PackedPart* part = find_part(numbers, number);
    return part == nullptr ? 0 : part->further_parts;
  };
  const uint32_t first = *(next - 1);
  return {static_cast<uint32_t>(next - numbers.first_order.begin()) - 1,
          order - first - (further_parts(order) - further_parts(first))};
}

vec2 weights_of_triangle(const PrimitiveNumbers& numbers, uint32_t order, uint32_t object, const vec2& weights) {
  vec2 whole = weights;
  if (const PackedPart* part = find_part(numbers, order); part != nullptr && part->order == order) {
    whole = part->weights[0] + weights.x * (part->weights[1] - part->weights[0]) +
            weights.y * (part->weights[2] - part->weights[0]);
  }
  return numbers.is_rewound.at(object) ? vec2(whole.y, whole.x) : whole;
}

}  // namespace promin
