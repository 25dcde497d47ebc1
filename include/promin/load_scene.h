// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "formats/source_file.h"
#include "promin/scene.h"

namespace promin {

/// Reads a scene by its ending: .gltf, .glb or .obj. The scene comes back checked: indices in range, numbers finite
/// and within kMinSize...kMaxCoordinate, no cycles. A scene without lights stays without: the caller adds a headlight.
/// Throws InputError with every problem found, each with place and cure; warnings lie in Scene::warnings.
Scene load_scene(const std::filesystem::path& file);
/// As much, and tells of each file that was read or missed, the scene's own first, also where this throws.
Scene load_scene(const std::filesystem::path& file, std::vector<SourceFile>& sources);

/// Coordinates and sizes beyond this, and sizes under kMinSize, are refused (fp32 would overflow).
inline constexpr double kMaxCoordinate = 1e15;
inline constexpr double kMinSize = 1e-22;

}  // namespace promin
