// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace promin {

/// Reads glTF 2.0, as text or GLB whichever the file holds. See load_scene for what is promised.
Scene load_gltf(const std::filesystem::path& file);

}  // namespace promin
