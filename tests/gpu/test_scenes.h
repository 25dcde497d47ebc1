// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/ray.h"
#include "promin/renderer.h"
#include "promin/scene.h"
#include "scene/world_scene.h"

namespace promin::test {

/// Every kind of primitive, of light and of material, mirrors and a smooth coloured mesh, with a scatter of
/// `sphere_count` small spheres so that the tree has some depth. The same scene for the same count.
world::Scene make_scene_of_everything(uint32_t sphere_count = 200);

/// The same with panes that blend, alone, in rows and in one place, solids that do, surfaces of one side and absent
/// ones.
world::Scene make_scene_of_alpha();

/// The same with glass of both models before it: solids, one within another, overlapping ones, a bubble, a smooth mesh,
/// thin walls, mirrors that hang on the angle, absorption.
world::Scene make_scene_of_glass();

/// A view of these scenes.
View make_view(uvec2 size);

/// Rays towards that scene from all around it.
std::vector<Ray> make_rays(size_t count);

/// A square from (-1, -1, z) to (1, 1, z) that faces +z, its texture coordinates from `lo` at the lower left corner to
/// `hi` at the upper right one; the second set is the first one's negative.
Mesh make_board(float z = 0.0F, const vec2& lo = vec2(0.0F), const vec2& hi = vec2(1.0F));

/// A view of boards, which fill it, orthographic from z = 2 towards -z; what lies at z > 2 is behind it.
View make_board_view(const uvec2& size, uint32_t samples = 1);

/// A material that shows its colour alone.
Material make_unlit(const vec3& color, AlphaMode mode = AlphaMode::kOpaque, float alpha = 1.0F);

/// Light of this power that travels along a direction of any length.
Light make_sun(const vec3& direction, float power = 1.0F);

/// Adds an image of these texels, from v = 0 on, and a texture whose texels are squares of one colour; the texture's
/// number.
uint32_t add_texture(Scene& scene, const uvec2& size, const std::vector<uint32_t>& texels, ImageUse use);

/// Whether pictures are bit for bit the same.
bool has_same_bits(const Image& a, const Image& b);

}  // namespace promin::test
