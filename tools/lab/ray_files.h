// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "measure/ray_sets.h"
#include "scene/world_scene.h"

// Files with which other programs trace the same rays.
namespace promin::lab {

/// Writes each set of rays to FOLDER/PREFIX_SET.npy, as promin cast reads them.
void write_sets(const std::filesystem::path& folder, const std::string& prefix, std::span<const measure::RaySet> sets);

/// Writes the triangles of the scene's meshes to FOLDER/PREFIX_triangles.npy, with a member `corners` of 3 by 3
/// float32.
void write_triangles(const std::filesystem::path& folder, const std::string& prefix, const world::Scene& scene);

}  // namespace promin::lab
