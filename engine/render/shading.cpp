// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render/shading.h"

#include <array>

#include "layout.h"

namespace promin {

static_assert(static_cast<uint32_t>(Shading::kFull) == layout::SHADING_FULL);
static_assert(static_cast<uint32_t>(Shading::kSteps) == layout::SHADING_STEPS);

std::span<const std::string_view> shading_names() {
  static constexpr std::array<std::string_view, 7> kNames = {"full",      "normals", "uv",   "object",
                                                             "primitive", "depth",   "steps"};
  return kNames;
}

FeatureMask features_of(Shading shading) {
  return static_cast<FeatureMask>(shading) << layout::SHADING_SHIFT |
         (shading == Shading::kSteps ? layout::FEATURE_STEP_COUNTS : 0);
}

}  // namespace promin
