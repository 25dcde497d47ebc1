// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check alpha and sides (docs/model.md, "Alpha"): holes, blending, and backs that are not shown.
// boards_test.cpp has more tests of cutoffs, sides and shadows. Boards are unlit and fill the picture, so that its
// pixels have closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "gpu/ways_of_tracing.h"
#include "promin/setup_stats.h"
#include "promin/validate.h"
#include "trace/render/caster_access.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

Material make_blending(const vec3& color, float alpha = 1.0F) {
  return make_unlit(color, AlphaMode::kBlend, alpha);
}

/// Returns a white material that scatters all the light it gets.
Material make_matt() {
  Material material;
  material.phong() = Phong{.ambient = vec3(0.0F), .diffuse = vec3(1.0F)};
  return material;
}

void add_board(Scene& scene, float z, const Material& material) {
  scene.materials.push_back(material);
  scene.add("board", make_board(z), static_cast<uint32_t>(scene.materials.size() - 1));
}

/// Adds an image whose texels have these alphas, beginning at v = 0, and its texture.
void add_alpha_texture(Scene& scene, const uvec2& size, const std::vector<uint32_t>& alphas) {
  std::vector<uint32_t> texels;
  for (const uint32_t alpha : alphas) texels.push_back(alpha << 24 | 0xFFFFFFU);
  add_texture(scene, size, texels, ImageUse::kData);
}

class AlphaTest : public DeviceTest {
 protected:
  RenderResult trace(const Scene& scene, const View& view, const TunedRendererOptions& options = {}) {
    EXPECT_THAT(validate(scene), testing::IsEmpty());
    return make_renderer(device(), scene, options).render(view);
  }
  /// Returns the red of a row of a square picture whose rows are all alike.
  std::vector<float> reds(const Scene& scene, uint32_t side) {
    const Image image = trace(scene, make_board_view(uvec2(side))).image;
    std::vector<float> result;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      if (i < side) result.push_back(image.pixels[i].r);
      EXPECT_EQ(image.pixels[i].r, result[i % side]);
    }
    return result;
  }
};

// If mip levels were only means of alpha, they would be below the cutoff nearly everywhere.
TEST_F(AlphaTest, AMaskKeepsItsShareWhereItIsSmall) {
  Scene scene;
  std::vector<uint32_t> alphas;
  std::mt19937 generator(1);
  for (uint32_t i = 0; i < 128 * 128; ++i) alphas.push_back(generator() >> 30 == 0 ? 255 : 0);
  add_alpha_texture(scene, uvec2(128), alphas);
  scene.textures[0].has_levels = true;
  Material mask = make_unlit(vec3(0.0F), AlphaMode::kMask);
  std::get<Unlit>(mask.model).color_texture.texture = 0;
  add_board(scene, 0.0F, mask);
  scene.environment.background = vec3(1.0F);
  const Image image = trace(scene, make_board_view(uvec2(32))).image;
  const auto there = std::ranges::count_if(image.pixels, [](const vec3& pixel) { return pixel.r == 0.0F; });
  // A mean of 16 texels has few possible values. The possible fraction nearest to a quarter is 0.19. Without
  // scaling the fraction is 0.03.
  EXPECT_NEAR(static_cast<double>(there) / 1024, 0.19, 0.03);
}

TEST_F(AlphaTest, AMaskOfTooLittleAlphaIsNowhere) {
  Scene scene;
  add_board(scene, 0.0F, make_unlit(vec3(0.25F), AlphaMode::kMask, 0.49F));
  scene.materials.push_back(scene.materials[0]);
  scene.add("ball", Sphere{.radius = 0.5}, 1);
  add_board(scene, -1.0F, make_blending(vec3(0.5F)));
  EXPECT_THAT(reds(scene, 4), testing::Each(0.5F));
  // AOVs do not see the board either. They see the ball, because a solid counts as one that blends with alpha 0.
  TunedRendererOptions options;
  options.with_aovs = true;
  const Aovs aovs = trace(scene, make_board_view(uvec2(4)), options).aovs;
  EXPECT_EQ(aovs.object[0], 2U);
  EXPECT_EQ(aovs.object[5], 1U);
}

TEST_F(AlphaTest, WhatBlendsIsOverWhatIsBehind) {
  Scene scene;
  scene.environment.background = vec3(1.0F);
  add_alpha_texture(scene, {3, 1}, {0, 51, 255});
  Material pane = make_blending(vec3(0.0F), 0.5F);
  std::get<Unlit>(pane.model).color_texture.texture = 0;
  add_board(scene, -1.0F, make_blending(vec3(0.25F), 0.75F));
  add_board(scene, 0.0F, pane);
  const double behind = 0.75 * 0.25 + 0.25;
  const std::vector<float> pixels = reds(scene, 3);
  EXPECT_NEAR(pixels[0], behind, 1e-7);
  EXPECT_NEAR(pixels[1], 0.9 * behind, 1e-7);
  EXPECT_NEAR(pixels[2], 0.5 * behind, 1e-7);
}

TEST_F(AlphaTest, LayersAtTheSamePlaceAllCount) {
  // Surfaces at the same place blend in the order of their numbers, whichever triangle comes first in the tree.
  Scene scene;
  scene.environment.background = vec3(1.0F);
  for (const float color : {0.0F, 0.25F, 0.5F}) add_board(scene, 0.0F, make_blending(vec3(color), 0.5F));
  const double expected = 0.5 * 0.0 + 0.5 * (0.5 * 0.25 + 0.5 * (0.5 * 0.5 + 0.5 * 1.0));
  TunedRendererOptions options;
  for (const std::string_view builder : builder_names()) {
    options.builder = builder;
    const Image image = trace(scene, make_board_view({5, 5}), options).image;
    for (const vec3& pixel : image.pixels) EXPECT_NEAR(pixel.r, expected, 1e-7) << builder;
  }
}

TEST_F(AlphaTest, BothSidesOfASolidCount) {
  Scene scene;
  scene.environment.background = vec3(1.0F);
  scene.materials = {make_blending(vec3(0.0F), 0.5F)};
  scene.add("ball", Sphere{.radius = 3.0}, 0);
  View view = make_board_view({2, 2});
  view.camera.eye.z = 5.0F;
  const RenderResult result = trace(scene, view);
  for (const vec3& pixel : result.image.pixels) EXPECT_NEAR(pixel.r, 0.25, 1e-7);
  EXPECT_EQ(result.rays.primary, 4U);
  EXPECT_EQ(result.rays.passed, 8U);
  EXPECT_EQ(result.rays.total(), 4U);
}

TEST_F(AlphaTest, TheLastLayerCountsAsOpaque) {
  Scene scene;
  scene.environment.background = vec3(1.0F);
  for (uint32_t i = 0; i < layout::MOST_LAYERS; ++i) {
    add_board(scene, -0.01F * static_cast<float>(i), make_blending(vec3(0.0F), 0.01F));
  }
  EXPECT_NEAR(reds(scene, 1)[0], std::pow(0.99, layout::MOST_LAYERS), 1e-5);
  add_board(scene, -1.0F, make_blending(vec3(0.0F), 0.01F));
  EXPECT_EQ(reds(scene, 1)[0], 0.0F);
}

TEST_F(AlphaTest, WhatIsFaintIsNotFollowed) {
  for (const bool is_faint : {false, true}) {
    Scene scene;
    scene.environment.background = vec3(1.0F);
    const float alpha = is_faint ? 1.0F - 1.0F / 1025.0F : 1.0F - 1.0F / 1023.0F;
    add_board(scene, 0.0F, make_blending(vec3(0.5F), alpha));
    const RenderResult result = trace(scene, make_board_view({1, 1}));
    EXPECT_EQ(result.rays.passed, is_faint ? 0U : 1U);
    EXPECT_EQ(result.image.pixels[0].r == 0.5F, is_faint);
  }
}

TEST_F(AlphaTest, VerticesHaveAlpha) {
  for (const AlphaMode mode : {AlphaMode::kOpaque, AlphaMode::kMask, AlphaMode::kBlend}) {
    Scene scene;
    scene.environment.background = vec3(1.0F);
    scene.materials = {make_unlit(vec3(0.0F), mode)};
    Mesh mesh = make_board(0.0F);
    mesh.colors.assign(4, vec4(1, 1, 1, 0.25F));
    scene.add("board", mesh, 0);
    const float expected = mode == AlphaMode::kOpaque ? 0.0F : (mode == AlphaMode::kMask ? 1.0F : 0.75F);
    EXPECT_THAT(reds(scene, 3), testing::Each(testing::FloatEq(expected)));
  }
}

TEST_F(AlphaTest, MirrorsSeeBacksAsTheCameraDoes) {
  for (const bool is_double_sided : {true, false}) {
    Scene scene;
    Material mirror = make_matt();
    mirror.phong() = Phong{.ambient = vec3(0), .diffuse = vec3(0), .reflection = vec3(1)};
    add_board(scene, 0.0F, mirror);
    scene.environment.background = vec3(1.0F);
    Material behind_camera = make_unlit(vec3(0.25F), AlphaMode::kOpaque);
    behind_camera.is_double_sided = is_double_sided;
    add_board(scene, 3.0F, behind_camera);
    // The front of the surface faces away from the mirror.
    EXPECT_THAT(reds(scene, 2), testing::Each(is_double_sided ? 0.25F : 1.0F));
  }
}

TEST_F(AlphaTest, CastsSeeGeometry) {
  Scene scene;
  Material absent = make_unlit(vec3(1.0F), AlphaMode::kMask, 0.0F);
  absent.is_double_sided = false;
  add_board(scene, 0.0F, absent);
  const Ray ray{vec3(0.25F, 0.1F, -1.0F), 0.0F, vec3(0, 0, 1), std::numeric_limits<float>::infinity()};
  Hit hit;
  make_caster(device(), world::flatten(scene)).cast({&ray, 1}, {&hit, 1});
  EXPECT_EQ(hit.t, 1.0F);
}

TEST_F(AlphaTest, EveryWayOfTracingGivesTheSameBits) {
  const world::Scene scene = make_scene_of_alpha();
  View view = make_view({96, 72});
  view.samples_per_pixel = 3;
  const RenderResult expected = make_renderer(device(), scene).render(view);
  EXPECT_GT(expected.rays.passed, 1000U);
  for (const TunedRendererOptions& options : ways_of_tracing()) {
    const RenderResult result = make_renderer(device(), scene, options).render(view);
    EXPECT_TRUE(has_same_bits(result.image, expected.image));
    EXPECT_EQ(result.rays.passed, expected.rays.passed);
  }
}

// There are more light sources than the stream handles in one turn.
TEST_F(AlphaTest, ManySourcesLightWhatBlends) {
  world::Scene scene = make_scene_of_alpha();
  const View view = make_view({48, 36});
  const Light light = scene.lights[0];
  const Image expected = make_renderer(device(), scene, TunedRendererOptions()).render(view).image;
  // The dark sources come first, so that the next turn handles the sources that emit light.
  Light dark = light;
  dark.diffuse = dark.specular = vec3(0.0F);
  scene.lights.insert(scene.lights.begin(), layout::STREAM_SOURCES, dark);
  EXPECT_TRUE(has_same_bits(make_renderer(device(), scene, TunedRendererOptions()).render(view).image, expected));
}

}  // namespace
}  // namespace promin::test
