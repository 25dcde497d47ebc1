// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "oracle/surface.h"

namespace promin::oracle {
namespace {

uint32_t grey(uint32_t code) {
  return code * 0x010101U | 0xFF000000U;
}

/// A square of side 1 whose texture coordinates are its positions, and an image on it.
struct Square {
  world::Scene scene;
  TextureSlot slot{.texture = 0};

  Square(const uvec2& size, ImageUse use, const std::function<uint32_t(uint32_t, uint32_t)>& texel) {
    auto image = std::make_shared<TextureImage>();
    image->size = size;
    image->use = use;
    for (uint32_t y = 0; y < size.y; ++y) {
      for (uint32_t x = 0; x < size.x; ++x) image->texels.push_back(texel(x, y));
    }
    scene.images = {image};
    scene.textures = {Texture{}};
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    mesh.uvs = {{0, 0, 0, 0}, {1, 0, 0, -1}, {1, 1, 1, -1}};
    mesh.triangles = {{0, 1, 2}};
    scene.objects = {{"", mesh, 0}};
  }
  TrianglePoint point(Real u, Real v) const {
    TrianglePoint point;
    point.mesh = std::get_if<Mesh>(&scene.objects[0].shape);
    point.u = u;
    point.v = v;
    return point;
  }
  Real red(const Vector2& place, Real level = 0) const { return Textures(scene).filter(slot, place, level).r; }
};

TEST(TextureTest, SrgbGoesThereAndBack) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_NEAR(encode_srgb(decode_srgb(code / 255.0L)), code / 255.0L, 2e-7L) << code;
  }
  EXPECT_NEAR(decode_srgb(0.5L), 0.21404114L, 1e-8L);
}

TEST(TextureTest, PlacesAreTransformedWeightsOfTheCorners) {
  Square square({1, 1}, ImageUse::kData, [](uint32_t, uint32_t) { return grey(0); });
  EXPECT_EQ(coordinates_at(square.slot, square.point(0.25L, 0.5L)), Vector2(0.75L, 0.5L));
  square.slot.uv_set = 1;
  EXPECT_EQ(coordinates_at(square.slot, square.point(0.25L, 0.5L)), Vector2(0.5L, -0.75L));
  square.slot = {.texture = 0, .to_u = {0, 2, 1}, .to_v = {-1, 0, 0.5F}};
  EXPECT_EQ(coordinates_at(square.slot, square.point(0.25L, 0.5L)), Vector2(2, -0.25L));
}

TEST(TextureTest, EdgesRepeatMirrorOrHold) {
  Square square({4, 1}, ImageUse::kData, [](uint32_t x, uint32_t) { return grey(60 * x); });
  const auto row = [&] {
    std::string codes;
    for (int i = -6; i < 9; ++i) codes += std::to_string(std::lround(255 * square.red({(i + 0.5L) / 4, 0.5L}) / 60));
    return codes;
  };
  EXPECT_EQ(row(), "230123012301230");
  square.scene.textures[0].wrap_u = TextureWrap::kMirroredRepeat;
  EXPECT_EQ(row(), "233210012332100");
  square.scene.textures[0].wrap_u = TextureWrap::kClampToEdge;
  EXPECT_EQ(row(), "000000012333333");
}

TEST(TextureTest, LinearFilteringIsBetweenTheMiddlesAndAcrossEdges) {
  Square square({2, 1}, ImageUse::kData, [](uint32_t x, uint32_t) { return grey(255 * x); });
  EXPECT_EQ(square.red({0.25L, 0.5L}), 0);
  EXPECT_EQ(square.red({0.5L, 0.5L}), 0.5L);
  EXPECT_EQ(square.red({0.0L, 0.5L}), 0.5L);
  square.scene.textures[0].wrap_u = TextureWrap::kClampToEdge;
  EXPECT_EQ(square.red({0.0L, 0.5L}), 0);
  square.scene.textures[0].is_magnified_linearly = false;
  EXPECT_EQ(square.red({0.49L, 0.5L}), 0);
  EXPECT_EQ(square.red({0.51L, 0.5L}), 1);
}

TEST(TextureTest, LevelsAreMeansOverAreasInLinearLight) {
  Square colors({2, 2}, ImageUse::kColor, [](uint32_t x, uint32_t y) { return grey((x + y) % 2 == 0 ? 255 : 0); });
  EXPECT_EQ(colors.red({0.5L, 0.5L}, 1), decode_srgb(188 / 255.0L));
  // This level is a single texel.
  Square numbers({3, 1}, ImageUse::kData, [](uint32_t x, uint32_t) { return grey(x == 1 ? 240 : 0); });
  EXPECT_EQ(numbers.red({0.5L, 0.5L}, 1), 80 / 255.0L);
  // Each of the two texels covers two and a half texels.
  Square odd({5, 1}, ImageUse::kData, [](uint32_t x, uint32_t) { return grey(x == 2 ? 250 : 0); });
  odd.scene.textures[0].is_minified_linearly = false;
  EXPECT_EQ(odd.red({0.1L, 0.5L}, 1), 50 / 255.0L);
  EXPECT_EQ(odd.red({0.9L, 0.5L}, 1), 50 / 255.0L);
}

TEST(TextureTest, LevelsOfMasksKeepTheirShare) {
  // A quarter of the texels is present. Of the four means 0, 50, 60 and 100, one must be present: 100 becomes 128, and
  // the others are scaled by the same factor.
  const uint32_t kAlphas[4][4] = {{0, 0, 200, 0}, {0, 0, 0, 0}, {200, 40, 200, 200}, {0, 0, 0, 0}};
  Square square({4, 4}, ImageUse::kData, [&](uint32_t x, uint32_t y) { return kAlphas[y][x] << 24; });
  square.scene.textures[0].is_minified_linearly = false;
  const auto codes = [&] {
    const Textures textures(square.scene);
    std::vector<long> seen;
    for (const Vector2& place : {Vector2(0.2L, 0.2L), Vector2(0.7L, 0.2L), Vector2(0.2L, 0.7L), Vector2(0.7L, 0.7L)}) {
      seen.push_back(std::lround(255 * textures.filter(square.slot, place, 1).a));
    }
    return seen;
  };
  const std::vector<long> means{0, 50, 60, 100};
  EXPECT_EQ(codes(), means) << "no mask has it";
  Material mask;
  mask.model = Unlit{.color_texture = square.slot};
  mask.alpha_mode = AlphaMode::kMask;
  square.scene.materials = {mask};
  EXPECT_EQ(codes(), (std::vector<long>{0, 64, 77, 128}));
  // The material's factor raises the alpha that texels need: 0.5 / 0.7 is between 182 and 183 of 255.
  square.scene.materials[0].alpha = 0.7F;
  EXPECT_EQ(codes(), (std::vector<long>{0, 92, 110, 183}));
  square.scene.materials.push_back(mask);
  square.scene.materials[1].alpha_mode = AlphaMode::kBlend;
  EXPECT_EQ(codes(), means) << "something blends with it";
}

TEST(TextureTest, LevelsAreChosenByFilter) {
  Square square({4, 4}, ImageUse::kData, [](uint32_t x, uint32_t y) { return grey(x + y == 0 ? 240 : 0); });
  // The texels under the corner have 240, 60 and 15 in the next levels.
  const Vector2 place(0.1L, 0.1L);
  Texture& texture = square.scene.textures[0];
  texture.is_magnified_linearly = texture.is_minified_linearly = false;
  EXPECT_NEAR(square.red(place, 0.25L), 195 / 255.0L, 1e-15L);
  EXPECT_EQ(square.red(place, 7), 15 / 255.0L);
  EXPECT_EQ(square.red(place, -3), 240 / 255.0L);
  texture.are_levels_linear = false;
  EXPECT_EQ(square.red(place, 0.4L), 240 / 255.0L);
  EXPECT_EQ(square.red(place, 0.6L), 60 / 255.0L);
  texture.has_levels = false;
  EXPECT_EQ(square.red(place, 7), 240 / 255.0L);
}

TEST(TextureTest, TheLevelIsThatOfTheConesWidth) {
  Square square({64, 16}, ImageUse::kData, [](uint32_t, uint32_t) { return grey(0); });
  const Textures textures(square.scene);
  TrianglePoint point = square.point(0.2L, 0.2L);
  // A texel is 1/64 wide and 1/16 high, which is 1/32 in the geometric mean.
  point.width = 1.0L / 32;
  EXPECT_NEAR(textures.level_at(square.slot, point), 0, 1e-15L);
  point.width = 1.0L / 4;
  EXPECT_NEAR(textures.level_at(square.slot, point), 3, 1e-15L);
  point.cosine = 0.25L;
  EXPECT_NEAR(textures.level_at(square.slot, point), 4, 1e-15L);
  point.cosine = 0;
  EXPECT_NEAR(textures.level_at(square.slot, point), 6, 1e-15L);
  square.slot.to_u = vec3(4, 0, 0);
  EXPECT_NEAR(textures.level_at(square.slot, point), 7, 1e-15L);
}

TEST(TextureTest, TheErrorIsHowFarThePictureMoves) {
  Square square({2, 2}, ImageUse::kData, [](uint32_t x, uint32_t) { return grey(255 * x); });
  TrianglePoint point = square.point(0.4L, 0.05L);
  point.place_error = 0.01L;
  EXPECT_NEAR(Textures(square.scene).look_up(square.slot, point).error.r, 0.02L, 1e-5L);
  // If the place is near an edge, the nearest texel may be one or the other.
  square.scene.textures[0].is_magnified_linearly = false;
  EXPECT_LT(Textures(square.scene).look_up(square.slot, point).error.r, 1e-5L);
  point.place_error = 0.1L;
  EXPECT_GE(Textures(square.scene).look_up(square.slot, point).error.r, 1);
}

TEST(TextureTest, NormalsTurnInThePlaneOfTheTangent) {
  const Square square({1, 1}, ImageUse::kNormal, [](uint32_t, uint32_t) { return grey(0); });
  SurfacePoint point;
  point.geometric_normal = point.normal = Vector(0, 0, 1);
  point.on_triangle = square.point(0.2L, 0.2L);
  point.slots[kNormalSlot] = square.slot;
  const Vector down(0, 0, -1);
  const auto bend = [&](const Texel& texel) { return bend_normal(point, kNormalSlot, texel, 1, down); };
  // The first coordinate of the normal goes along x. The second one, green, goes along 1 - v, which is against y.
  EXPECT_LE(glm::distance(bend({1, 0.5L, 1, 1}), glm::normalize(Vector(1, 0, 1))), 1e-15L);
  EXPECT_LE(glm::distance(bend({0.5L, 1, 1, 1}), glm::normalize(Vector(0, -1, 1))), 1e-15L);
  // From behind, the same relief is seen.
  point.side = -1;
  point.geometric_normal = point.normal = Vector(0, 0, -1);
  const Vector behind = bend_normal(point, kNormalSlot, {1, 0.5L, 1, 1}, 1, Vector(0, 0, 1));
  EXPECT_LE(glm::distance(behind, glm::normalize(Vector(-1, 0, -1))), 1e-15L);
  // The normal is not bent beyond the direction where the surface is seen edge-on.
  const Vector grazing = bend_normal(point, kNormalSlot, {1, 0.5L, 0.5L, 1}, 1, glm::normalize(Vector(-1, 0, 0.01L)));
  EXPECT_NEAR(glm::dot(grazing, glm::normalize(Vector(-1, 0, 0.01L))), 0, 1e-15L);
}

}  // namespace
}  // namespace promin::oracle
