// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

#include "device/device.h"
#include "device_scene/device_scene.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "shared/layout.h"
#include "support/thorough.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

using test::has_same_bits;
using test::make_scene_of_everything;

const uvec2 kPictureSize(150, 100);  // neither number is a multiple of the block's size

class RendererTest : public test::DeviceTest {
 protected:
  /// Returns a renderer with the features of most scenes here, so that they share their kernels.
  static Renderer make(const world::Scene& scene, TunedRendererOptions options = {}) {
    options.more_features |= features_of(make_scene_of_everything()) | layout::FEATURE_HEADLIGHT;
    return make_renderer(device(), scene, options);
  }
  static RenderResult render(const world::Scene& scene, const View& view, const TunedRendererOptions& options = {}) {
    return make(scene, options).render(view);
  }
};

TEST_F(RendererTest, TwoRunsGiveTheSameBits) {
  const world::Scene scene = make_scene_of_everything();
  Renderer renderer = make(scene);
  const View view = test::make_view(kPictureSize);
  EXPECT_TRUE(has_same_bits(renderer.render(view).image, renderer.render(view).image));
}

TEST_F(RendererTest, BitsDoNotDependOnTheTiles) {
  const world::Scene scene = make_scene_of_everything();
  View view = test::make_view(kPictureSize);
  view.samples_per_pixel = 3;
  TunedRendererOptions single_blocks;
  single_blocks.blocks_per_dispatch = 1;
  TunedRendererOptions odd_blocks;
  odd_blocks.blocks_per_dispatch = 37;
  const RenderResult expected = render(scene, view);
  const RenderResult by_one = render(scene, view, single_blocks);
  const RenderResult by_many = render(scene, view, odd_blocks);
  EXPECT_TRUE(has_same_bits(by_one.image, expected.image));
  EXPECT_TRUE(has_same_bits(by_many.image, expected.image));
  EXPECT_EQ(by_one.rays.total(), expected.rays.total());
  EXPECT_EQ(by_many.rays.total(), expected.rays.total());
}

TEST_F(RendererTest, BitsDoNotDependOnThePackets) {
  const world::Scene scene = make_scene_of_everything();
  View view = test::make_view(kPictureSize);
  view.samples_per_pixel = 3;
  TunedRendererOptions options;
  options.with_aovs = true;
  options.packet_size = 1;
  const RenderResult expected = render(scene, view, options);
  for (const uint32_t packet_size : {2U, 4U}) {
    options.packet_size = packet_size;
    const RenderResult result = render(scene, view, options);
    EXPECT_TRUE(has_same_bits(result.image, expected.image)) << packet_size;
    EXPECT_EQ(result.rays.shadow, expected.rays.shadow) << packet_size;
    EXPECT_EQ(result.rays.total(), expected.rays.total()) << packet_size;
    EXPECT_EQ(result.aovs.normal, expected.aovs.normal) << packet_size;
    EXPECT_EQ(result.aovs.depth, expected.aovs.depth) << packet_size;
    EXPECT_EQ(result.aovs.primitive, expected.aovs.primitive) << packet_size;
  }
}

TEST_F(RendererTest, FewSamplesAreTracedBySinglePixels) {
  // This test opens its own device, on which nothing has been compiled.
  const gpu::DeviceHandle own = gpu::open_device();
  if (own->profile().pixel_packet_size == 1) GTEST_SKIP() << "the device takes no packets";
  const world::Scene scene = make_scene_of_everything();
  const auto compiled_by = [&](const TunedRendererOptions& options) {
    const size_t before = own->compiled_pipelines().size();
    const Renderer renderer = make_renderer(*own, scene, options);
    return own->compiled_pipelines().size() - before;
  };
  TunedRendererOptions single;
  single.packet_size = 1;
  EXPECT_GT(compiled_by(single), 0U);
  TunedRendererOptions few;
  few.expected_samples = own->profile().samples_that_repay_packets - 1;
  EXPECT_EQ(compiled_by(few), 0U) << "another kernel than that of single pixels";
  TunedRendererOptions many;
  many.expected_samples = own->profile().samples_that_repay_packets;
  EXPECT_EQ(compiled_by(many), 1U) << "not the camera stage by packets";
}

// The same memory can be read in two ways: as words of a storage buffer, and as texels.
TEST_F(RendererTest, TexelsAndStorageBuffersGiveTheSameBits) {
  constexpr uint64_t kEnough = uint64_t{1} << 26;
  if (device().profile().most_texel_bytes < kEnough) GTEST_SKIP() << "the device's texel buffers are too small";
  std::vector<std::pair<world::Scene, View>> pictures = {
      {make_scene_of_everything(2000), test::make_view(kPictureSize)}};
  for (const char* name :
       test::cases_of<const char*>({"showcase.gltf", "light_physical.gltf", "vertex_colors.gltf"}, 0)) {
    world::Scene scene = world::flatten(load_scene(std::filesystem::path(PROMIN_SCENES_DIR) / name));
    View view;
    view.size = kPictureSize;
    view.camera = scene.cameras.at(0);
    pictures.emplace_back(std::move(scene), view);
  }
  for (const auto& [scene, view] : pictures) {
    const bool has_texels = DeviceScene(device(), pack_scene(scene, "sah")).fetches_texels();
    ASSERT_TRUE(has_texels);
    TunedRendererOptions options;
    options.with_aovs = true;
    const RenderResult by_texels = render(scene, view, options);
    options.avoids_texels = true;
    const RenderResult by_words = render(scene, view, options);
    EXPECT_TRUE(has_same_bits(by_words.image, by_texels.image)) << scene.objects.size() << " objects";
    EXPECT_EQ(by_words.rays.shadow, by_texels.rays.shadow);
    EXPECT_EQ(by_words.rays.total(), by_texels.rays.total());
    EXPECT_EQ(by_words.aovs.normal, by_texels.aovs.normal);
    EXPECT_EQ(by_words.aovs.depth, by_texels.aovs.depth);
    EXPECT_EQ(by_words.aovs.object, by_texels.aovs.object);
    EXPECT_EQ(by_words.aovs.primitive, by_texels.aovs.primitive);
  }
}

TEST_F(RendererTest, ACropHasTheBitsOfTheWhole) {
  const world::Scene scene = make_scene_of_everything();
  View view = test::make_view(kPictureSize);
  Renderer renderer = make(scene);
  const Image whole = renderer.render(view).image;
  view.crop = PixelWindow{uvec2(13, 29), uvec2(90, 71)};
  const Image crop = renderer.render(view).image;
  ASSERT_EQ(crop.size, uvec2(77, 42));
  for (uint32_t y = 0; y < crop.size.y; ++y) {
    for (uint32_t x = 0; x < crop.size.x; ++x) {
      ASSERT_EQ(crop.at(x, y), whole.at(x + 13, y + 29)) << "pixel " << x << ", " << y << " of the crop";
    }
  }
}

TEST_F(RendererTest, BitsDoNotDependOnTheBuilder) {
  const world::Scene scene = make_scene_of_everything(2000);
  const View view = test::make_view(kPictureSize);
  const Image expected = render(scene, view).image;
  for (const std::string_view builder : builder_names()) {
    TunedRendererOptions options;
    options.builder = builder;
    EXPECT_TRUE(has_same_bits(render(scene, view, options).image, expected)) << builder;
  }
}

// Features that a scene does not use cost only time, and change no bit.
TEST_F(RendererTest, SpecialisationChangesNoBit) {
  world::Scene spheres = make_scene_of_everything();
  std::erase_if(spheres.objects,
                [](const world::Object& o) { return !std::holds_alternative<world::Sphere>(o.shape); });
  for (Light& light : spheres.lights) light.kind = LightKind::kPoint;
  const world::Scene everything = make_scene_of_everything();
  TunedRendererOptions forced;
  forced.more_features = all_features();
  for (const world::Scene* scene : std::array<const world::Scene*, 2>{&spheres, &everything}) {
    const View view = test::make_view(kPictureSize);
    Renderer specialised = make_renderer(device(), *scene);
    Renderer general = make_renderer(device(), *scene, forced);
    EXPECT_EQ(specialised.setup_stats().features, feature_names(features_of(*scene)));
    EXPECT_EQ(general.setup_stats().features, feature_names(all_features()));
    EXPECT_TRUE(has_same_bits(specialised.render(view).image, general.render(view).image));
  }
}

// A solid's own wall lies between its inside and a light outside.
TEST_F(RendererTest, TheInsideOfASphereIsDark) {
  world::Scene scene;
  scene.materials.resize(1);
  scene.objects = {{"", world::Sphere{vec3(0.0F), 1.0F}, 0}};
  scene.lights = {make_headlight()};
  View view;
  view.size = uvec2(16, 16);
  for (const vec3& pixel : render(scene, view).image.pixels) EXPECT_EQ(pixel, vec3(0.0F));
}

TEST_F(RendererTest, TheHeadlightFollowsTheCameraOfEachView) {
  world::Scene scene = make_scene_of_everything();
  scene.lights = {make_headlight()};
  Renderer renderer = make(scene);
  View view = test::make_view(kPictureSize);
  for (const vec3& look : {vec3(0, 0, -1), vec3(0.28F, 0, -0.96F), vec3(-0.6F, 0, -0.8F)}) {
    view.camera.look = look;
    view.camera.up = vec3(0, 1, 0);
    scene.lights[0].kind = LightKind::kDirectional;
    scene.lights[0].direction = look;
    EXPECT_TRUE(has_same_bits(renderer.render(view).image, render(scene, view).image));
  }
}

TEST_F(RendererTest, CountsRays) {
  world::Scene scene;
  scene.materials.resize(1);
  scene.objects = {{"", world::Sphere{vec3(0, 0, -3), 1.0F}, 0}, {"", world::Sphere{vec3(0, 0, 100), 1.0F}, 0}};
  scene.lights = {make_headlight()};
  View view;
  view.size = uvec2(64, 64);
  view.samples_per_pixel = 4;
  const RenderResult dull = render(scene, view);
  EXPECT_EQ(dull.rays.primary, 64U * 64U * 4U);
  EXPECT_EQ(dull.rays.reflection, 0U);
  // Every hit faces the headlight and sends one shadow ray. Their number is the disk's fraction of the picture.
  const double radius = std::tan(std::asin(1.0 / 3.0)) / std::tan(0.35) * 32.0;
  EXPECT_NEAR(static_cast<double>(dull.rays.shadow), 3.14159 * radius * radius * 4.0, 150.0);

  scene.materials[0].phong().reflection = vec3(0.5F);
  const RenderResult mirror = render(scene, view);
  EXPECT_GE(mirror.rays.reflection, dull.rays.shadow);
  view.max_depth = 0;
  EXPECT_EQ(render(scene, view).rays.reflection, 0U);
}

TEST_F(RendererTest, ScenesOfNothingShowTheBackground) {
  world::Scene scene;
  scene.materials.resize(1);
  scene.environment.background = vec3(0.25F, 0.5F, 0.75F);
  View view;
  view.size = uvec2(9, 5);
  TunedRendererOptions forced;
  forced.more_features = all_features();
  for (const TunedRendererOptions& options : {TunedRendererOptions(), forced}) {
    const Image image = make_renderer(device(), scene, options).render(view).image;
    for (const vec3& pixel : image.pixels) EXPECT_EQ(pixel, scene.environment.background);
  }
}

TEST_F(RendererTest, TheSkyIsBehindAllWhereItIsShown) {
  world::Scene scene;
  scene.materials.resize(1);
  // The light is the same from all directions, so that every representation of a sky can store it exactly.
  const vec3 color(0.5F, 0.25F, 0.125F);
  scene.environment.ambient = color;
  scene.environment.sky = GradientSky{.top = color, .horizon = color, .bottom = color};
  scene.environment.background = vec3(2.0F);
  View view;
  view.size = uvec2(9, 5);
  TunedRendererOptions forced;
  forced.more_features = all_features();
  for (const TunedRendererOptions& options : {TunedRendererOptions(), forced}) {
    Renderer renderer = make_renderer(device(), scene, options);
    for (const vec3& pixel : renderer.render(view).image.pixels) EXPECT_EQ(pixel, vec3(2.0F));
    Environment shown = scene.environment;
    shown.shows_sky = true;
    renderer.set_environment(shown);
    for (const vec3& pixel : renderer.render(view).image.pixels) {
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(pixel[i], color[i], 2e-3F * color[i]);
    }
    shown.sky = std::monostate();
    renderer.set_environment(shown);
    for (const vec3& pixel : renderer.render(view).image.pixels) EXPECT_EQ(pixel, vec3(2.0F)) << "there is none";
  }
}

/// Returns mirrors that absorb no light and emit 1/1024 each, and sources that illuminate no mirror.
world::Scene make_facing_mirrors(uint32_t light_count) {
  world::Scene scene;
  scene.materials.resize(1);
  scene.materials[0].phong().diffuse = vec3(0.0F);
  scene.materials[0].emissive = vec3(1.0F / 1024.0F);
  scene.materials[0].phong().reflection = vec3(1.0F);
  scene.objects = {{"", world::Plane{vec3(0, 0, -1), vec3(0, 0, 1)}, 0},
                   {"", world::Plane{vec3(0, 0, 1), vec3(0, 0, -1)}, 0}};
  scene.lights.resize(light_count);
  for (Light& light : scene.lights) light.position = vec3(0, 0, 1);
  return scene;
}

// With facing mirrors each bounce multiplies by kr, and the last bounce adds nothing.
TEST_F(RendererTest, MirrorsAddUpToTheirDepth) {
  world::Scene scene;
  scene.materials.resize(1);
  scene.materials[0].phong().ambient = vec3(1.0F);
  scene.materials[0].phong().diffuse = vec3(0.0F);
  scene.materials[0].phong().reflection = vec3(0.5F);
  scene.environment.ambient = vec3(1.0F);
  scene.objects = {{"", world::Plane{vec3(0, 0, -1), vec3(0, 0, 1)}, 0},
                   {"", world::Plane{vec3(0, 0, 1), vec3(0, 0, -1)}, 0}};
  View view;
  view.size = uvec2(1, 1);
  for (const uint32_t depth : {0U, 1U, 2U, 10U}) {
    view.max_depth = depth;
    const float expected = 2.0F - std::ldexp(1.0F, -static_cast<int>(depth));
    EXPECT_EQ(render(scene, view).image.pixels[0], vec3(expected)) << "depth " << depth;
  }
}

// llvmpipe ends the loops of a lane after 65535 iterations. Therefore a lane traces one ray at a time.
TEST_F(RendererTest, ManyBouncesAreTracedToTheEnd) {
  View view;
  view.size = uvec2(128, 144);
  view.max_depth = 100;
  TunedRendererOptions options;
  options.target_dispatch_ms = 1e5;  // the second dispatch takes all that the first one has left
  const float expected = 101.0F / 1024.0F;
  const RenderResult result = make_renderer(device(), make_facing_mirrors(60), options).render(view);
  for (const vec3& pixel : result.image.pixels) ASSERT_EQ(pixel, vec3(expected));
  EXPECT_EQ(result.rays.reflection, 100U * 128U * 144U);
}

TEST_F(RendererTest, TheGreatestDepthIsTracedWithManySources) {
  View view;
  view.size = uvec2(1, 1);
  view.max_depth = kMaxDepth;
  EXPECT_EQ(make_renderer(device(), make_facing_mirrors(60)).render(view).image.pixels[0], vec3(1001.0F / 1024.0F));
}

// A turn of the stream takes the shadow rays to at most STREAM_SOURCES sources. The test uses fewer sources, exactly
// this number, one more, and several turns of sources.
TEST_F(RendererTest, AMirrorShowsWhatAnyNumberOfSourcesLights) {
  for (const uint32_t count : {1U, layout::STREAM_SOURCES, layout::STREAM_SOURCES + 1, 3 * layout::STREAM_SOURCES}) {
    SCOPED_TRACE(testing::Message() << count << " sources");
    world::Scene scene = test::make_scene_of_everything();
    scene.lights.resize(count);
    for (uint32_t i = 0; i < count; ++i) {
      scene.lights[i] = {};
      scene.lights[i].position =
          vec3(std::cos(0.7F * static_cast<float>(i)), 2.0F, std::sin(0.7F * static_cast<float>(i))) * 3.0F;
      scene.lights[i].diffuse = vec3(1.0F) / static_cast<float>(count);
    }
    View view = test::make_view(uvec2(48, 32));
    view.max_depth = 4;
    // The picture is the sum of the pictures with each source alone, except for rounding.
    const RenderResult all = render(scene, view);
    EXPECT_GT(all.rays.reflection, 0U);
    world::Scene part = scene;
    part.lights.clear();
    const Image own = render(part, view).image;
    Image sum = own;
    RayCounts rays;
    for (const Light& light : scene.lights) {
      part.lights = {light};
      const RenderResult one = render(part, view);
      rays.shadow += one.rays.shadow;
      for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += one.image.pixels[i] - own.pixels[i];
    }
    EXPECT_EQ(all.rays.shadow, rays.shadow);
    for (size_t i = 0; i < sum.pixels.size(); ++i) {
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(all.image.pixels[i][c], sum.pixels[i][c], 2e-5F) << "pixel " << i;
    }
  }
}

TEST_F(RendererTest, NothingNearerThanTheNearPlaneIsDrawn) {
  world::Scene scene;
  scene.materials.resize(1);
  scene.materials[0].emissive = vec3(1.0F);
  scene.objects = {{"", world::Plane{vec3(0, 0, -2), vec3(0, 0, 1)}, 0}};
  View view;
  view.size = uvec2(3, 3);
  view.camera.yfov = 2.0F;
  view.camera.near = 1.999F;  // near is a distance along the view, not along the ray
  for (const vec3& pixel : render(scene, view).image.pixels) EXPECT_EQ(pixel, vec3(1.0F));
  view.camera.near = 2.001F;
  for (const vec3& pixel : render(scene, view).image.pixels) EXPECT_EQ(pixel, vec3(0.0F));
}

TEST_F(RendererTest, PicturesLargerThanAFilmComeInBands) {
  world::Scene scene;
  scene.materials.resize(1);
  scene.materials[0].emissive = vec3(1.0F, 0.5F, 0.25F);
  scene.objects = {{"", world::Sphere{vec3(0, 0, -3), 1.0F}, 0}};
  View view;
  view.size = uvec2(2048, 2304);  // the picture has 4.7 million pixels; a film holds 4.2 million
  view.max_depth = 0;
  const Image large = render(scene, view).image;
  for (uint32_t y = 0; y < view.size.y; y += 64) {
    EXPECT_EQ(large.at(1024, y), large.at(1024, view.size.y - 1 - y)) << "row " << y;
  }
  EXPECT_EQ(large.at(1024, 1152), vec3(1.0F, 0.5F, 0.25F));
  EXPECT_EQ(large.at(0, 2303), vec3(0.0F));
}

TEST_F(RendererTest, UnknownBuildersAreRefused) {
  TunedRendererOptions options;
  options.builder = "shah";
  EXPECT_THROW(make_renderer(device(), make_scene_of_everything(), options), UsageError);
}

}  // namespace
}  // namespace promin
