// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "promin/math.h"
#include "promin/validate.h"
#include "shapes/shapes.h"

namespace promin {

/// Returns whether all coordinates are numbers up to 1e15.
inline bool is_in_range(const dvec3& p) {
  // The comparisons are written so that NaN fails.
  return std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate && std::abs(p.z) <= kMaxCoordinate;
}

/// Returns whether fp32 can represent a size of a shape in the world; false for NaN.
inline bool is_valid(const NamedSize& size) {
  return (size.size >= kMinSize || (size.may_be_zero && size.size == 0.0)) && size.size <= kMaxCoordinate;
}

}  // namespace promin
