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

/// The features that follow from a scene's geometry alone, from materials and from lights. A picture needs them all,
/// and what picture_features adds for their combination.
FeatureMask geometry_features(std::span<const world::Object> objects);
/// The features of materials that are shown, by index.
FeatureMask material_features(std::span<const Material> materials, const std::vector<bool>& is_shown);
/// The features of lights that are on.
FeatureMask light_features(std::span<const Light> lights);
/// The features of what surrounds the scene.
FeatureMask environment_features(const Environment& environment);

/// The features that decide what a ray meets.
FeatureMask primitive_features();

/// The materials of objects that are drawn.
std::vector<bool> find_shown_materials(std::span<const world::Object> objects, size_t material_count);

/// The features of a picture, from those of its parts: without lights nothing shines, and a flat primitive alone throws
/// no shadow.
FeatureMask picture_features(FeatureMask geometry, FeatureMask materials, FeatureMask lights, FeatureMask environment,
                             uint64_t primitive_count);

/// The features that a picture of this scene needs, without camera and depth.
FeatureMask features_of(const world::Scene& scene);

/// The features that a pipeline for a debug view has beside the scene's.
FeatureMask features_of(DebugView view);

/// Whether a picture of these features shows unlit surfaces or a backdrop as they are.
bool shows_unlit(FeatureMask features, DebugView view);

/// Everything that a scene may use.
FeatureMask all_features();

/// Names of the features in a mask, for `promin info`.
std::vector<std::string> feature_names(FeatureMask features);

}  // namespace promin
