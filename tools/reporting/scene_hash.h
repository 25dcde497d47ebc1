// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene/world_scene.h"

namespace promin::report {

/// 16 hexadecimal digits over what a scene holds as it was loaded: shapes, materials, lights, cameras, ambient light
/// and background, in the file's order. Names, and how a tree sorts the shapes, are not in it.
std::string hash_of(const world::Scene& scene);

}  // namespace promin::report
