// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/feature_mask.h"
#include "promin/debug_view.h"
#include "scene/world_scene.h"

namespace promin {

/// What of a scene's features follows from its geometry alone, from materials and from lights. A picture needs them
/// all, and what picture_features adds for what they are together.
FeatureMask geometry_features(std::span<const world::Object> objects);
/// Of those that are shown, by index.
FeatureMask material_features(std::span<const Material> materials, const std::vector<bool>& is_shown);
/// Of those that are on.
FeatureMask light_features(std::span<const Light> lights);

/// The features that decide what a ray meets.
FeatureMask primitive_features();

/// The materials of objects that are drawn.
std::vector<bool> find_shown_materials(std::span<const world::Object> objects, size_t material_count);

/// The features of a picture, of those of its parts: nothing shines without lights, and a flat primitive alone throws
/// no shadow.
FeatureMask picture_features(FeatureMask geometry, FeatureMask materials, FeatureMask lights, uint64_t primitive_count);

/// The features that a picture of this scene needs, without camera and depth.
FeatureMask features_of(const world::Scene& scene);

/// What a pipeline for a debug view has beside the scene's features.
FeatureMask features_of(DebugView view);

/// Everything that a scene may use.
FeatureMask all_features();

/// Names of the features in a mask, for `promin info`.
std::vector<std::string> feature_names(FeatureMask features);

}  // namespace promin
