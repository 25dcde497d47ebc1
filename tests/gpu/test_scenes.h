// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/ray.h"
#include "promin/renderer.h"
#include "promin/scene.h"
#include "scene/world_scene.h"

namespace promin::test {

/// Returns a scene with every kind of primitive, of light and of material, with mirrors and a smooth coloured mesh.
/// `sphere_count` small spheres are scattered in it, so that the tree has some depth. The scene depends only on this
/// count.
world::Scene make_scene_of_everything(uint32_t sphere_count = 200);

/// Returns the same scene with panes that blend, alone, in rows and in one place, with solids that blend, surfaces of
/// one side and absent ones.
world::Scene make_scene_of_alpha();

/// Returns the same scene with glass of both models in front of it: solids, one inside another, overlapping ones, a
/// bubble, a smooth mesh, thin walls, mirrors that depend on the angle, absorption.
world::Scene make_scene_of_glass();

/// Returns a view of these scenes.
View make_view(uvec2 size);

/// Returns rays from all around towards the scene of everything.
std::vector<Ray> make_rays(size_t count);

/// Returns a square from (-1, -1, z) to (1, 1, z) that faces +z. Its texture coordinates go from `lo` at the lower left
/// corner to `hi` at the upper right one; the second set is the negative of the first.
Mesh make_board(float z = 0.0F, const vec2& lo = vec2(0.0F), const vec2& hi = vec2(1.0F));

/// Returns an orthographic view from z = 2 along -z, which boards fill; objects at z > 2 are behind the camera.
View make_board_view(const uvec2& size, uint32_t samples = 1);

/// Returns a material that shows only its colour.
Material make_unlit(const vec3& color, AlphaMode mode = AlphaMode::kOpaque, float alpha = 1.0F);

/// Returns a directional light of this power. Its direction may have any length.
Light make_sun(const vec3& direction, float power = 1.0F);

/// Adds an image of these texels, from v = 0 on, and a texture that shows its texels as squares of one colour. Returns
/// the texture's number.
uint32_t add_texture(Scene& scene, const uvec2& size, const std::vector<uint32_t>& texels, ImageUse use);

/// Returns whether two pictures are bit for bit the same.
bool has_same_bits(const Image& a, const Image& b);

}  // namespace promin::test
