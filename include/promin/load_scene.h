// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "promin/export.h"
#include "promin/scene.h"

namespace promin {

/// Reads a scene by its ending: .gltf, .glb, .obj, .ply or .stl. The scene comes back valid (promin/validate.h). A scene
/// without lights stays without, see light_scene (promin/lighting.h). Throws InputError with every problem found, each
/// with place and cure; warnings lie in Scene::warnings. Any thread may call it.
PROMIN_EXPORT Scene load_scene(const std::filesystem::path& file);

}  // namespace promin
