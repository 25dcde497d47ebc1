// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "promin/renderer.h"
#include "scene/world_scene.h"

// Scenes of textures and skies, for pictures that the oracle draws too.
namespace promin::test {

/// Boards with textures in rows over a textured floor, with a wall and a ball of triangles that mirror them.
struct Gallery {
  world::Scene scene;
  uint32_t board_count = 0;

  /// Makes the floor, the wall and the lights.
  Gallery();

  /// Adds a texture with a noise image of its own, with four channels from `low` to 255. Returns the texture's number.
  uint32_t add_noise(const uvec2& size, ImageUse use, uint32_t low = 0);

  /// Adds the next board, 1.1 wide and high, turned a little. Its texture coordinates go from -0.4 to 1.6; those in set
  /// 1 differ.
  Mesh& add_board(const Material& material, float turn = 0.0F);

  /// Adds a ball of triangles with vertex normals.
  Mesh& add_ball(const vec3& center, float radius, const Material& material);
};

/// Returns a material of the metallic-roughness model.
Material make_metallic(float metallic, float roughness, const vec3& color = vec3(1.0F));

/// Returns boards with textures of the metallic-roughness model, in all of its slots, sets and transforms.
world::Scene make_gallery_of_metallic_roughness();

/// Returns boards with textures of Phong's model and of unlit materials, with every filter and wrap mode.
world::Scene make_gallery_of_phong();

/// Returns boards that blend with what is behind them, and boards cut by a mask.
world::Scene make_gallery_of_alpha();

View make_gallery_view(uvec2 size);

/// These functions return skies: a gradient, the studio, and a panorama of a few broad lights; the last two are
/// rotated.
Environment make_gradient();
Environment make_studio();
Environment make_panorama();

/// Returns white metals side by side. Each is a ball of diameter 1 in a square of `side` pixels.
world::Scene make_row_of_metals(const Environment& environment, std::span<const float> roughnesses);
View make_view_of_row(size_t count, uint32_t side);

/// Returns balls over a floor under a sky: metals and dielectrics, smooth and rough, with a coat, with a sheen, of
/// Phong's model and half transparent.
world::Scene make_scene_under_sky(const Environment& environment);

}  // namespace promin::test
