// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// Returns the luminance of linear light with the primaries of sRGB (IEC 61966-2-1).
inline double luminance_of(const dvec3& color) {
  return glm::dot(color, dvec3(0.2126, 0.7152, 0.0722));
}

}  // namespace promin
