// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "scene/features.h"

namespace promin {

/// What a picture shows: light, or of each camera ray what docs/shadings.md says. As SHADING_* of shaders/layout.h.
enum class Shading : uint32_t { kFull, kNormals, kUv, kObject, kPrimitive, kDepth, kSteps };

/// Names for people, by the value of the Shading.
std::span<const std::string_view> shading_names();

/// What a pipeline for it has beside the scene's features.
FeatureMask features_of(Shading shading);

}  // namespace promin
