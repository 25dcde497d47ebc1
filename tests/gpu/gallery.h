// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "promin/renderer.h"
#include "scene/world_scene.h"

// Scenes of textures and skies, for pictures that the oracle draws too.
namespace promin::test {

/// Boards with textures in rows over a floor that has one, a wall that mirrors them and a ball of triangles that does.
struct Gallery {
  world::Scene scene;
  uint32_t board_count = 0;

  /// With the floor, the wall and lights.
  Gallery();

  /// A texture of an image of noise of its own, of four channels from `low` to 255.
  uint32_t add_noise(const uvec2& size, ImageUse use, uint32_t low = 0);

  /// The next board, 1.1 wide and high, turned a little, with texture coordinates from -0.4 to 1.6, in set 1 others.
  Mesh& add_board(const Material& material, float turn = 0.0F);

  /// A ball of triangles with vertex normals.
  Mesh& add_ball(const vec3& center, float radius, const Material& material);
};

/// A material of the metallic-roughness model.
Material make_metallic(float metallic, float roughness, const vec3& color = vec3(1.0F));

/// Textures of the metallic-roughness model in boards: all of its slots, sets and transforms.
world::Scene make_gallery_of_metallic_roughness();

/// Textures of Phong's model and of unlit materials, with every filter and wrap mode.
world::Scene make_gallery_of_phong();

/// Boards that blend with what is behind them, and boards cut by a mask.
world::Scene make_gallery_of_alpha();

View make_gallery_view(uvec2 size);

/// Skies: a gradient, the studio, and a panorama of a few broad lights, the latter two turned.
Environment make_gradient();
Environment make_studio();
Environment make_panorama();

/// White metals side by side, each a ball of the diameter 1 in a square of `side` pixels.
world::Scene make_row_of_metals(const Environment& environment, std::span<const float> roughnesses);
View make_view_of_row(size_t count, uint32_t side);

/// Balls of metal and dielectric, smooth and rough, with a coat, with a sheen, of Phong's model and half transparent,
/// over a floor under a sky.
world::Scene make_scene_under_sky(const Environment& environment);

}  // namespace promin::test
