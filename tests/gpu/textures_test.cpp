// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/rounding.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "gpu/ways_of_tracing.h"
#include "promin/validate.h"
#include "textures/pack_images.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

/// Decodes as in IEC 61966-2-1.
double decode_srgb(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

/// Returns an unlit board, so that the picture shows only the texture.
Scene make_textured_board(const TextureImage& image, const vec2& lo = vec2(0), const vec2& hi = vec2(1)) {
  Scene scene;
  scene.materials = {make_unlit(vec3(1.0F))};
  std::get<Unlit>(scene.materials[0].model).color_texture.texture = 0;
  scene.images = {std::make_shared<TextureImage>(image)};
  scene.textures = {Texture{}};
  scene.add("board", make_board(0.0F, lo, hi));
  return scene;
}

TextureImage make_image(const uvec2& size, const std::function<uint32_t(uint32_t, uint32_t)>& texel,
                        ImageUse use = ImageUse::kData) {
  TextureImage image{.name = "", .size = size, .texels = {}, .use = use};
  for (uint32_t y = 0; y < size.y; ++y) {
    for (uint32_t x = 0; x < size.x; ++x) image.texels.push_back(texel(x, y));
  }
  return image;
}

uint32_t grey(uint32_t value) {
  return value * 0x010101U | 0xFF000000U;
}

class TexturesTest : public DeviceTest {
 protected:
  Image render(const Scene& scene, const View& view, const TunedRendererOptions& options = {}) {
    EXPECT_THAT(validate(scene), testing::IsEmpty());
    return make_renderer(device(), scene, options).render(view).image;
  }
};

TEST_F(TexturesTest, AConstantTextureIsAFactor) {
  for (const uint32_t code : {0U, 1U, 10U, 11U, 128U, 254U, 255U}) {
    for (const ImageUse use : {ImageUse::kColor, ImageUse::kData}) {
      Scene scene = make_textured_board(make_image(
                                            {5, 3}, [&](uint32_t, uint32_t) { return grey(code); }, use),
                                        vec2(-1.5F), vec2(2.25F));
      const Image image = render(scene, make_board_view({16, 16}));
      const double number = code / 255.0;
      const double expected = use == ImageUse::kColor ? decode_srgb(number) : number;
      EXPECT_NEAR(static_cast<double>(image.pixels[0].r), expected, 0.006 / 255.0) << code;
      for (const vec3& pixel : image.pixels) EXPECT_EQ(pixel, image.pixels[0]) << code;
    }
  }
}

TEST_F(TexturesTest, TexelsLieWhereTheyBelong) {
  // The first row lies at v = 0, and is the lowest here.
  Scene scene =
      make_textured_board(make_image({2, 2}, [](uint32_t x, uint32_t y) { return grey(10 * (1 + x + 2 * y)); }));
  scene.textures[0].is_magnified_linearly = false;
  const Image image = render(scene, make_board_view({2, 2}));
  const auto code = [&](size_t i) { return std::lround(255.0F * image.pixels[i].r); };
  EXPECT_EQ(code(0), 30);
  EXPECT_EQ(code(1), 40);
  EXPECT_EQ(code(2), 10);
  EXPECT_EQ(code(3), 20);
}

TEST_F(TexturesTest, EdgesRepeatMirrorOrHold) {
  // The texture has four texels along u, which goes from -2 to 3: these are 20 texels, each a pixel.
  const struct {
    TextureWrap wrap;
    const char* row;
  } kCases[] = {{TextureWrap::kRepeat, "01230123012301230123"},
                {TextureWrap::kMirroredRepeat, "01233210012332100123"},
                {TextureWrap::kClampToEdge, "00000000012333333333"}};
  for (const auto& [wrap, row] : kCases) {
    for (const bool is_linear : {false, true}) {
      Scene scene = make_textured_board(make_image({4, 1}, [](uint32_t x, uint32_t) { return grey(60 * x); }),
                                        vec2(-2, 0), vec2(3, 1));
      scene.textures[0].wrap_u = wrap;
      scene.textures[0].is_magnified_linearly = is_linear;
      View view = make_board_view({20, 20});
      const Image image = render(scene, view);
      std::string codes;
      for (int x = 0; x < 20; ++x) codes += static_cast<char>('0' + std::lround(255.0F * image.pixels[x].r / 60.0F));
      // Pixel centres are texel centres, so both filters give the same.
      EXPECT_EQ(codes, row) << is_linear;
    }
  }
}

TEST_F(TexturesTest, BilinearBetweenTexels) {
  // The texture has two texels, 0 and 1, and clamps: for u = 0 ... 1 it gives 0 up to 1/4, 1 from 3/4 on, and a line
  // between them.
  Scene scene = make_textured_board(make_image({2, 1}, [](uint32_t x, uint32_t) { return grey(255 * x); }));
  scene.textures[0].wrap_u = TextureWrap::kClampToEdge;
  const uint32_t width = 64;
  const Image image = render(scene, make_board_view({width, width}));
  for (uint32_t x = 0; x < width; ++x) {
    const double u = (x + 0.5) / width;
    EXPECT_NEAR(static_cast<double>(image.pixels[x].r), std::clamp(2.0 * u - 0.5, 0.0, 1.0), 0x1p-20) << x;
  }
}

TEST_F(TexturesTest, SmallTexelsAreAveraged) {
  // A checkerboard of 256 x 256 texels is seen in 16 x 16 pixels: each pixel covers 16 * 16 texels, as many light as
  // dark ones.
  const TextureImage checkers = make_image(
      {256, 256}, [](uint32_t x, uint32_t y) { return grey((x + y) % 2 == 0 ? 255 : 0); }, ImageUse::kColor);
  Scene scene = make_textured_board(checkers);
  for (const uint32_t samples : {1U, 4U}) {
    const Image image = render(scene, make_board_view({16, 16}, samples));
    // The code of 1/2 is 188, and this is its light.
    for (const vec3& pixel : image.pixels) EXPECT_NEAR(static_cast<double>(pixel.r), decode_srgb(188 / 255.0), 1e-4);
  }
  scene.textures[0].has_levels = false;
  scene.textures[0].is_minified_linearly = false;
  for (const vec3& pixel : render(scene, make_board_view({16, 16})).pixels) {
    EXPECT_TRUE(pixel.r < 1e-5F || pixel.r > 1.0F - 1e-5F);
  }
}

TEST_F(TexturesTest, TheLevelFollowsTheDistance) {
  // A texture of noise fades to its mean if texels are smaller than pixels.
  const TextureImage noise = make_image(
      {64, 64}, [](uint32_t x, uint32_t y) { return grey(((x * 2654435761U) ^ (y * 2246822519U)) >> 13 & 255); });
  const auto contrast = [&](float distance, const std::function<void(Scene&)>& change) {
    Scene scene = make_textured_board(noise, vec2(0), vec2(4));
    change(scene);
    View view;
    view.camera.eye = vec3(0, 0, distance);
    view.camera.yfov = 2.0F * std::atan(1.0F / distance);
    view.size = uvec2(64);
    const Image image = render(scene, view);
    double least = 1.0;
    double most = 0.0;
    for (const vec3& pixel : image.pixels) {
      least = std::min(least, static_cast<double>(pixel.g));
      most = std::max(most, static_cast<double>(pixel.g));
    }
    return most - least;
  };
  const auto nothing = [](Scene&) {};
  // The square fills the picture from any distance, so a pixel always covers the same number of texels.
  EXPECT_NEAR(contrast(2.0F, nothing), contrast(100.0F, nothing), 0.02);
  const auto without_levels = [](Scene& scene) { scene.textures[0].has_levels = false; };
  EXPECT_GT(contrast(2.0F, without_levels), contrast(2.0F, nothing) + 0.1);
}

/// Returns a metallic-roughness board that is lit by one light from the upper left in place of the studio.
Scene make_lit_board(const TextureImage& image) {
  Scene scene = make_textured_board(image);
  MetallicRoughness material;
  material.metallic = 0.0F;
  material.base_color = vec3(0.8F);
  scene.materials[0].model = material;
  Mesh& mesh = std::get<Mesh>(scene.geometries[0]);
  mesh.normals.assign(4, vec3(0, 0, 1));
  scene.lights = {make_sun(vec3(1, -1, -1))};
  scene.environment.ambient = vec3(0.25F);
  return scene;
}

TEST_F(TexturesTest, OcclusionDimsTheEnvironmentAlone) {
  Scene scene = make_lit_board(make_image({1, 1}, [](uint32_t, uint32_t) { return grey(51); }));
  const auto center = [&] { return render(scene, make_board_view({8, 8})).pixels[27].r; };
  auto& material = std::get<MetallicRoughness>(scene.materials[0].model);
  const float open = center();
  material.occlusion_texture.texture = 0;
  const float dimmed = center();
  scene.lights.clear();
  const float dimmed_alone = center();
  material.occlusion_texture = {};
  const float open_alone = center();
  // A fifth of the environment's light and all light of the source remain.
  EXPECT_NEAR(dimmed_alone, 0.2F * open_alone, 1e-6F);
  EXPECT_NEAR(dimmed - dimmed_alone, open - open_alone, 1e-6F);
  scene.materials[0].model = [&] {
    auto half = material;
    half.occlusion_texture.texture = 0;
    half.occlusion_strength = 0.5F;
    return half;
  }();
  EXPECT_NEAR(center(), 0.6F * open_alone, 1e-6F);
}

TEST_F(TexturesTest, PhongMaterialsHaveFactorsToo) {
  // Red is a fifth; green and blue are 1.
  const auto shaded = [&](const std::function<void(Phong&)>& change) {
    Scene scene = make_lit_board(make_image({1, 1}, [](uint32_t, uint32_t) { return 0xFFFFFF33U; }));
    scene.environment.background = vec3(1.0F);
    Phong phong{.ambient = vec3(0.5F), .diffuse = vec3(0.5F)};
    change(phong);
    scene.materials[0].model = phong;
    return render(scene, make_board_view({8, 8})).pixels[27];
  };
  const vec3 matt = shaded([](Phong&) {});
  const vec3 textured = shaded([](Phong& phong) { phong.diffuse_texture.texture = 0; });
  EXPECT_NEAR(textured.r, 0.2F * matt.r, 1e-6F);
  EXPECT_EQ(textured.g, matt.g);
  const auto glossy = [](Phong& phong) {
    phong.specular = vec3(1.0F);
    phong.shininess = 1.0F;
    phong.reflection = vec3(0.5F);
  };
  const vec3 whole = shaded(glossy);
  const vec3 part = shaded([&](Phong& phong) {
    glossy(phong);
    phong.specular_texture.texture = 0;
  });
  EXPECT_GT(whole.r, matt.r + 0.6F);
  EXPECT_NEAR(part.r - matt.r, 0.2F * (whole.r - matt.r), 1e-6F);
  EXPECT_EQ(part.g, whole.g);
  // The texel's normal leans towards -u and -v; -v goes up here.
  const vec3 turned = shaded([](Phong& phong) { phong.normal_texture.texture = 0; });
  const vec3 to_light = glm::normalize(vec3(-1, 1, 1));
  const vec3 normal = glm::normalize(vec3(-0.6F, -1.0F, 1.0F));
  EXPECT_NEAR(turned.r, 0.5F * 0.25F + 0.5F * glm::dot(normal, to_light), 1e-5F);
}

TEST_F(TexturesTest, ACoatHasItsOwnNormalAndFactors) {
  // A light below the surface adds nothing.
  uint32_t texel = 0xFFFF80C0U;
  const auto shaded = [&](const std::function<void(MetallicRoughness&)>& change) {
    Scene scene = make_lit_board(make_image(
        {1, 1}, [&](uint32_t, uint32_t) { return texel; }, ImageUse::kNormal));
    auto& material = std::get<MetallicRoughness>(scene.materials[0].model);
    material.base_color = vec3(0.0F);
    material.specular = 0.0F;
    material.clearcoat = 0.5F;
    material.clearcoat_roughness = 0.5F;
    change(material);
    return render(scene, make_board_view({8, 8})).pixels[27].r;
  };
  const float bare = shaded([](MetallicRoughness&) {});
  EXPECT_GT(bare, 0.0F);
  EXPECT_EQ(shaded([](MetallicRoughness& m) { m.normal_texture.texture = 0; }), bare);
  EXPECT_NE(shaded([](MetallicRoughness& m) { m.clearcoat_normal_texture.texture = 0; }), bare);
  // Red is 0xC0 of 255, green 0x80.
  EXPECT_NEAR(shaded([](MetallicRoughness& m) { m.clearcoat_texture.texture = 0; }), bare * 192.0F / 255.0F, 1e-6F);
  const float smoother = shaded([](MetallicRoughness& m) { m.clearcoat_roughness = 0.5F * 128.0F / 255.0F; });
  EXPECT_NEAR(shaded([](MetallicRoughness& m) { m.clearcoat_roughness_texture.texture = 0; }), smoother, 1e-6F);
  // The normal is turned away from the light, to +x and -y.
  texel = 0xFF90FFFFU;
  EXPECT_EQ(shaded([](MetallicRoughness& m) { m.normal_texture.texture = 0; }), bare);
}

TEST_F(TexturesTest, ASheenHasItsOwnFactors) {
  // Alpha holds the roughness.
  const auto shaded = [&](const vec3& color, float roughness, const std::function<void(MetallicRoughness&)>& change) {
    Scene scene = make_lit_board(make_image(
        {1, 1}, [](uint32_t, uint32_t) { return 0x60FF8000U; }, ImageUse::kData));
    auto& material = std::get<MetallicRoughness>(scene.materials[0].model);
    material.base_color = vec3(0.0F);
    material.specular = 0.0F;
    material.sheen_color = color;
    material.sheen_roughness = roughness;
    change(material);
    return render(scene, make_board_view({8, 8})).pixels[27];
  };
  const auto nothing = [](MetallicRoughness&) {};
  const vec3 bare = shaded(vec3(1.0F), 1.0F, nothing);
  EXPECT_GT(bare.g, 0.0F);
  const vec3 colored = shaded(vec3(1.0F), 1.0F, [](MetallicRoughness& m) { m.sheen_color_texture.texture = 0; });
  EXPECT_EQ(colored.r, 0.0F);
  EXPECT_NEAR(colored.g, bare.g * 128.0F / 255.0F, 1e-6F);
  EXPECT_EQ(colored.b, bare.b);
  const vec3 smoother = shaded(vec3(1.0F), 96.0F / 255.0F, nothing);
  EXPECT_LT(smoother.g, 0.9F * bare.g);
  EXPECT_NEAR(shaded(vec3(1.0F), 1.0F, [](MetallicRoughness& m) { m.sheen_roughness_texture.texture = 0; }).g,
              smoother.g, 1e-6F);
}

TEST_F(TexturesTest, WhatADielectricReflectsHasFactors) {
  const auto shaded = [&](const std::function<void(MetallicRoughness&)>& change) {
    Scene scene = make_lit_board(make_image(
        {1, 1}, [](uint32_t, uint32_t) { return 0x80FF8000U; }, ImageUse::kData));
    auto& material = std::get<MetallicRoughness>(scene.materials[0].model);
    material.base_color = vec3(0.0F);
    material.metallic = 0.0F;
    material.roughness = 0.5F;
    change(material);
    return render(scene, make_board_view({8, 8})).pixels[27];
  };
  constexpr float kHalf = 128.0F / 255.0F;
  const auto near = [](const vec3& a, const vec3& b) { return max_component(glm::abs(a - b)) <= 1e-6F; };
  const vec3 weaker = shaded([](MetallicRoughness& m) { m.specular = kHalf; });
  EXPECT_LT(weaker.r, 0.9F * shaded([](MetallicRoughness&) {}).r);
  EXPECT_TRUE(near(shaded([](MetallicRoughness& m) { m.specular_texture.texture = 0; }), weaker));
  const vec3 colored = shaded([](MetallicRoughness& m) { m.specular_color = vec3(0.0F, kHalf, 1.0F); });
  EXPECT_LT(colored.r, 0.9F * colored.b);
  EXPECT_TRUE(near(shaded([](MetallicRoughness& m) { m.specular_color_texture.texture = 0; }), colored));
  // Values above 1 are cut only after the texture.
  const vec3 strong = shaded([](MetallicRoughness& m) { m.specular_color = vec3(0.0F, 40.0F * kHalf, 40.0F); });
  EXPECT_TRUE(near(shaded([](MetallicRoughness& m) {
                     m.specular_color = vec3(40.0F);
                     m.specular_color_texture.texture = 0;
                   }),
                   strong));
}

TEST_F(TexturesTest, ANormalTextureTurnsTheNormal) {
  // The texture's +X goes along +u. Its +Y goes against +v, as images have their first row at v = 0; on the board v
  // goes up.
  const auto shaded = [&](uint32_t texel, bool has_tangents, float turn) {
    Scene scene = make_lit_board(make_image(
        {1, 1}, [&](uint32_t, uint32_t) { return texel; }, ImageUse::kNormal));
    Mesh& mesh = std::get<Mesh>(scene.geometries[0]);
    if (has_tangents) mesh.tangents.assign(4, vec4(1, 0, 0, -1));
    if (turn != 0.0F) mesh.normals.assign(4, vec3(turn, 0, std::sqrt(1.0F - turn * turn)));
    if (texel != 0) std::get<MetallicRoughness>(scene.materials[0].model).normal_texture.texture = 0;
    return render(scene, make_board_view({8, 8})).pixels[27].r;
  };
  // The normal has x = 204 / 255 * 2 - 1 = 0.6 and z = 0.8.
  const uint32_t to_the_right = 204 | 127 << 8 | 230 << 16;
  for (const bool has_tangents : {false, true}) {
    EXPECT_NEAR(shaded(to_the_right, has_tangents, 0.0F), shaded(0, false, 0.6F), 0.01F);
    EXPECT_LT(shaded(to_the_right, has_tangents, 0.0F), shaded(0, false, 0.0F) - 0.05F);
    // Green points up in the picture's space, which is down along v here: away from the light above.
    const uint32_t along_green = 127 | 204 << 8 | 230 << 16;
    EXPECT_LT(shaded(along_green, has_tangents, 0.0F), shaded(0, false, 0.0F) - 0.05F);
  }
}

TEST_F(TexturesTest, EveryWayOfTracingGivesTheSameBits) {
  const TextureImage noise = make_image(
      {61, 37}, [](uint32_t x, uint32_t y) { return (x * 2654435761U) ^ (y * 40503U * 65537U); }, ImageUse::kColor);
  Scene scene = make_lit_board(noise);
  auto& material = std::get<MetallicRoughness>(scene.materials[0].model);
  material.metallic = 1.0F;
  for (TextureSlot* slot : {&material.base_color_texture, &material.metallic_roughness_texture,
                            &material.normal_texture, &material.occlusion_texture}) {
    slot->texture = 0;
  }
  scene.materials[0].emissive_texture.texture = 0;
  scene.materials[0].emissive = vec3(0.5F);
  scene.add("ball", Sphere{.radius = 0.5}, 0);
  View view = make_board_view({96, 64}, 3);
  view.camera.projection = Projection::kPerspective;
  view.camera.eye = vec3(0.5F, 0.25F, 3.0F);
  const Image image = render(scene, view);
  for (const TunedRendererOptions& options : ways_of_tracing()) {
    EXPECT_TRUE(has_same_bits(image, render(scene, view, options)));
  }
}

/// Returns a board of metal with up to five images of equal size. The first four make a bundle. Three have colours, one
/// more than a bundle may have.
Scene make_board_of_images(size_t image_count) {
  const auto noise = [](uint32_t seed, ImageUse use) {
    return make_image(
        {37, 22}, [=](uint32_t x, uint32_t y) { return ((x + seed) * 2654435761U) ^ (y * 40503U * 65537U); }, use);
  };
  Scene scene = make_lit_board(noise(1, ImageUse::kData));
  scene.images.clear();
  scene.textures.clear();
  auto& material = std::get<MetallicRoughness>(scene.materials[0].model);
  scene.materials[0].emissive = vec3(0.5F);
  const std::pair<TextureSlot*, ImageUse> slots[] = {{&material.metallic_roughness_texture, ImageUse::kData},
                                                     {&material.base_color_texture, ImageUse::kColor},
                                                     {&material.normal_texture, ImageUse::kNormal},
                                                     {&scene.materials[0].emissive_texture, ImageUse::kColor},
                                                     {&material.specular_color_texture, ImageUse::kColor}};
  for (uint32_t i = 0; i < image_count; ++i) {
    slots[i].first->texture = i;
    scene.images.push_back(std::make_shared<TextureImage>(noise(i + 2, slots[i].second)));
    scene.textures.push_back({.image = i, .wrap_u = TextureWrap::kMirroredRepeat});
  }
  material.occlusion_texture = material.metallic_roughness_texture;
  return scene;
}

TEST_F(TexturesTest, ImagesSideBySideHaveTheSameBits) {
  View view = make_board_view({48, 32}, 3);
  view.camera.projection = Projection::kPerspective;
  view.camera.eye = vec3(0.5F, 0.25F, 3.0F);
  for (const size_t image_count : {2U, 3U, 5U}) {
    const Scene scene = make_board_of_images(image_count);
    TunedRendererOptions alone;
    alone.repack = [&](PackedScene packed) {
      EXPECT_TRUE(packed.features.has_any(layout::FEATURE_TEXTURE_BUNDLES));
      packed.surfaces.images = pack_images(scene.images, scene.textures);
      packed.features = packed.features.without(layout::FEATURE_TEXTURE_BUNDLES);
      return packed;
    };
    const Image image = render(scene, view, alone);
    TunedRendererOptions without_texels;
    without_texels.avoids_texels = true;
    for (const TunedRendererOptions& options : {TunedRendererOptions(), without_texels}) {
      EXPECT_TRUE(has_same_bits(image, render(scene, view, options))) << image_count << " images";
    }
  }
}

}  // namespace
}  // namespace promin::test
