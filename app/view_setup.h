// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "console.h"
#include "promin/renderer.h"
#include "promin/scene.h"
#include "render_options.h"

namespace promin::app {

/// The view that the options ask of this scene. A scene without a camera gets one that frames it, and an orthographic
/// camera with a field of view becomes a perspective one; a note says so.
/// Throws UsageError for an unknown camera, parallel directions, a crop outside the picture.
View make_view(const Scene& scene, const ViewOptions& options, const Console& console);

/// Gives a scene without lights a headlight, which follows the camera of each view, and ambient light where it has
/// none. A note says so.
void light_up(Scene& scene, const Console& console);

/// Throws UsageError where the scene, with its default lights, has no light of such an index.
void check_lights(const Scene& scene, const std::vector<uint32_t>& indices);

/// Switches lights off by their indices, and all others on.
void switch_lights(std::vector<Light>& lights, const std::vector<uint32_t>& off);

}  // namespace promin::app
