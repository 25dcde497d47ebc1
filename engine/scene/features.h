// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "promin/scene.h"

namespace promin {

/// Bits FEATURE_* of shaders/layout.h: what a scene uses and a pipeline is specialised to.
using FeatureMask = uint32_t;

/// The features that a picture of this scene needs, without camera and depth.
FeatureMask features_of(const Scene& scene);

FeatureMask all_features();

/// Names of the features in a mask, for `promin info`.
std::vector<std::string> feature_names(FeatureMask features);

}  // namespace promin
