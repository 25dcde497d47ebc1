// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/ray.h"
#include "promin/renderer.h"
#include "scene/world_scene.h"

namespace promin::test {

/// Every kind of primitive, of light and of material, mirrors and a smooth coloured mesh, with a scatter of
/// `sphere_count` small spheres so that the tree has some depth. The same scene for the same count.
world::Scene make_scene_of_everything(uint32_t sphere_count = 200);

/// The same with panes that blend, alone, in rows and in one place, solids that do, surfaces of one side and absent
/// ones.
world::Scene make_scene_of_alpha();

/// A view of these scenes.
View make_view(uvec2 size);

/// Rays towards that scene from all around it.
std::vector<Ray> make_rays(size_t count);

/// Sum of absolute differences over bits: 0 only if the pictures are bit for bit the same.
bool has_same_bits(const Image& a, const Image& b);

}  // namespace promin::test
