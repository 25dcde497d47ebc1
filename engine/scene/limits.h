// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "promin/error.h"
#include "promin/math.h"
#include "promin/validate.h"
#include "shapes/shapes.h"

namespace promin {

/// Returns whether all coordinates are numbers up to 1e15.
inline bool is_in_range(const dvec3& p) {
  // The comparisons are written so that NaN fails.
  return std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate && std::abs(p.z) <= kMaxCoordinate;
}

/// Returns whether all corners of a transformed box are in range. The box is not empty.
inline bool is_in_range(const Bounds& box, const dmat4& world_from_object) {
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p((corner & 1) != 0 ? box.hi.x : box.lo.x, (corner & 2) != 0 ? box.hi.y : box.lo.y,
                  (corner & 4) != 0 ? box.hi.z : box.lo.z);
    if (!is_in_range(dvec3(world_from_object * dvec4(p, 1.0)))) return false;
  }
  return true;
}

/// Returns the problem of the transform of an object: numbers that are not finite, a last row that is not 0 0 0 1, or a
/// singular linear part. Returns nullopt for a valid transform. The problem has no place.
std::optional<Problem> find_transform_problem(const dmat4& world_from_object);

/// Returns whether fp32 can represent a size of a shape in the world; false for NaN.
inline bool is_valid(const NamedSize& size) {
  return (size.size >= kMinSize || (size.may_be_zero && size.size == 0.0)) && size.size <= kMaxCoordinate;
}

}  // namespace promin
