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

/// Returns the features that a scene's geometry uses. A picture also needs the features of materials and lights, and
/// the features that picture_features() adds for their combination.
FeatureMask geometry_features(const world::Scene& scene);
/// Returns the features of the visible materials. `is_shown` is indexed by material.
FeatureMask material_features(std::span<const Material> materials, const std::vector<bool>& is_shown);
/// Returns the features of the lights that are on.
FeatureMask light_features(std::span<const Light> lights);
/// Returns the features of the scene's environment.
FeatureMask environment_features(const Environment& environment);

/// Returns the features that determine which primitives a ray can hit.
FeatureMask primitive_features();

/// Returns for each material whether a visible object uses it.
std::vector<bool> find_shown_materials(const world::Scene& scene);

/// Returns the features of a picture from the features of its parts. Some combinations need fewer features: without
/// lights there are no highlights, and a single flat primitive casts no shadow.
FeatureMask picture_features(FeatureMask geometry, FeatureMask materials, FeatureMask lights, FeatureMask environment,
                             uint64_t primitive_count);

/// Returns whether this geometry may cast a shadow on itself.
bool casts_shadows(FeatureMask geometry, uint64_t primitive_count);

/// Returns the features that a picture of this scene needs, without those of its camera and depth.
FeatureMask features_of(const world::Scene& scene);

/// Returns the features that a pipeline for a debug view has in addition to the scene's.
FeatureMask features_of(DebugView view);

/// Returns whether a picture with these features displays unlit surfaces or a backdrop without changing their colours.
bool shows_unlit(FeatureMask features, DebugView view);

/// Returns all features that a scene without instances may use. Scenes with instances have kernels of their own,
/// because a second level of the tree slows all rays down and changes the number of their steps.
FeatureMask all_features();

/// Returns the names of the features in a mask, for `promin info`.
std::vector<std::string> feature_names(FeatureMask features);

}  // namespace promin
