// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// What each pixel's middle sample shows, that of index samples / 2: with an odd number of samples the pixel's centre.
/// Row by row, as the image:
///   depth      distance from the eye (orthographic: from the plane through it); infinite on a miss
///   normal     geometric normal as Hit::normal, never flipped to the ray; 0 on a miss
///   object, primitive  as Hit::object and Hit::primitive; kNoId on a miss
struct Aovs {
  static constexpr uint32_t kNoId = 0xFFFFFFFF;

#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL) std::vector<TYPE> FIELD;
#include "promin/kinds/aovs.def"

  /// Makes all of them so many values, which say that nothing was hit.
  PROMIN_EXPORT void resize(size_t pixel_count);
};

/// Names of the AOVs, in their order.
PROMIN_EXPORT std::span<const std::string_view> aov_names();

}  // namespace promin
