// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/scene.h"

namespace promin {

/// The implementation of frame_scene and add_default_lights, for both forms of a scene.
Camera frame_bounds(const Bounds& bounds, float aspect_ratio);
AddedLights add_default_lights(std::vector<Light>& lights, Environment& environment);

/// A box of size 2, to look at where nothing is finite.
Bounds bounds_around(const vec3& center);

}  // namespace promin
