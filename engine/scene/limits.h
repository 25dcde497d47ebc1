// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/validate.h"
#include "shapes/shapes.h"

namespace promin {

/// Whether fp32 can hold a size of a shape in the world; false for NaN.
inline bool is_valid(const NamedSize& size) {
  return (size.size >= kMinSize || (size.may_be_zero && size.size == 0.0)) && size.size <= kMaxCoordinate;
}

}  // namespace promin
