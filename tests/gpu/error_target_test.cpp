// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check pictures with an error target: they must be as exact as they claim, and equal however they are
// made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/display.h"
#include "promin/error.h"
#include "promin/framing.h"
#include "promin/lighting.h"
#include "promin/load_scene.h"
#include "support/thorough.h"
#include "trace/film/pixel_estimate.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

View with_target(View view, float error, uint32_t least = 8, uint32_t most = 256) {
  view.error_target = ErrorTarget{.error = error, .min_samples = least, .max_samples = most};
  return view;
}

View view_of(const Scene& scene, const uvec2& size) {
  View view;
  view.camera = scene.cameras.empty() ? frame_scene(scene, static_cast<float>(size.x) / static_cast<float>(size.y))
                                      : scene.cameras.front();
  view.size = size;
  view.max_depth = default_max_depth(scene);
  return view;
}

/// Returns wires in front of a dark wall, lit from the front. They are at least a quarter of a pixel wide.
world::Scene make_wires() {
  world::Scene scene;
  scene.materials = {make_unlit(vec3(0.9F, 0.6F, 0.2F))};
  scene.environment.background = vec3(0.05F);
  for (int i = 0; i < 12; ++i) {
    const float angle = 0.13F + 0.25F * static_cast<float>(i);
    const vec3 along(std::cos(angle), std::sin(angle), 0.0F);
    const vec3 center(0.04F * static_cast<float>(i - 6), 0.03F * static_cast<float>(i - 6), 0.0F);
    scene.objects.push_back({"wire", world::Cylinder{center, along, 2.0F, 0.004F * static_cast<float>(1 + i % 4)}, 0});
  }
  return scene;
}

/// Returns a flat board of squares of all colours, which is visible up to the horizon.
Scene make_floor() {
  Scene scene;
  std::vector<uint32_t> texels;
  for (uint32_t i = 0; i < 64; ++i) texels.push_back(0xFF000000U | (i * 0x9E3779U & 0xFFFFFFU));
  Material material = make_unlit(vec3(1.0F));
  std::get<Unlit>(material.model).color_texture.texture = add_texture(scene, uvec2(8), texels, ImageUse::kColor);
  scene.materials = {material};
  scene.geometries = {make_board(0.0F, vec2(0.0F), vec2(12.0F))};
  scene.objects = {{"floor", 0, 0}};
  return scene;
}

class ErrorTargetTest : public DeviceTest {
 protected:
  /// Compares a picture's claims with a picture of many samples on a lattice, in linear light and as the picture is
  /// shown.
  static void expect_honest(Renderer& renderer, View view, const char* name, const DisplayTransform& display) {
    View fine = view;
    fine.error_target.reset();
    // The reference picture has errors of its own, so it takes many times the samples that the target takes.
    fine.samples_per_pixel = view.error_target->error < 1.0F / 32.0F ? 1024 : 256;
    const Image truth = renderer.render(fine).image;
    expect_honest(renderer, view, name, truth);
    view.error_target->display = display;
    expect_honest(renderer, view, name, truth);
  }

 private:
  static void expect_honest(Renderer& renderer, const View& view, const char* name, const Image& truth) {
    const RenderResult result = renderer.render(view);
    const std::optional<DisplayTransform>& display = view.error_target->display;
    size_t refined = 0;
    size_t honest = 0;
    for (size_t i = 0; i < truth.pixels.size(); ++i) {
      if (result.aovs.samples[i] == view.error_target->min_samples) continue;
      ++refined;
      const vec3& written = result.image.pixels[i];
      vec3 error = glm::abs(written - truth.pixels[i]);
      vec3 claim = result.aovs.error[i];
      if (display) {
        error = glm::abs(shown_color(written, *display) - shown_color(truth.pixels[i], *display));
        claim = shown_claim(claim, written, *display);
      }
      honest += glm::all(glm::lessThanEqual(error, claim)) ? 1 : 0;
    }
    const double share = static_cast<double>(honest) / static_cast<double>(refined);
    std::printf("%-16s %-7s %6.2f spp, %5zu pixels refined, %.2f %% honest\n", name, display ? "display" : "linear",
                static_cast<double>(result.error->samples) / static_cast<double>(truth.pixels.size()), refined,
                100.0 * share);
    EXPECT_GE(share, 0.95) << name;
    EXPECT_GE(refined, truth.pixels.size() / 50) << name;
  }
};

TEST_F(ErrorTargetTest, ClaimsHoldOf95In100Pixels) {
  TunedRendererOptions options;
  options.with_aovs = true;
  for (const char* name : cases_of<const char*>({"mirrors", "sphereflake", "showcase", "glass"}, 2)) {
    Scene scene = load_scene(std::filesystem::path(PROMIN_SCENES_DIR) / (std::string(name) + ".gltf"));
    light_scene(scene, LightChoice::kAuto);
    Renderer renderer = make_renderer(device(), scene, options);
    expect_honest(renderer, with_target(view_of(scene, uvec2(48, 36)), 1.0F / 64.0F), name, display_of(scene));
    // This is how promin render begins coarse pictures. With few samples a claim is most likely to be too small by
    // chance.
    const uvec2 size = is_thorough() ? uvec2(96, 72) : uvec2(48, 36);
    const View coarse = with_target(view_of(scene, size), 1.0F / 16.0F, kMinRefinedSamples);
    expect_honest(renderer, coarse, name, display_of(scene));
  }
  Renderer wires = make_renderer(device(), make_wires(), options);
  View view = make_board_view(uvec2(is_thorough() ? 48 : 32));
  expect_honest(wires, with_target(view, 1.0F / 64.0F), "wires", {.tone_mapping = ToneMapping::kAces});
  Renderer floor = make_renderer(device(), make_floor(), options);
  view.camera = Camera{};
  view.camera.eye = vec3(0.1F, -1.3F, 0.3F);
  view.camera.look = glm::normalize(vec3(0.05F, 1.0F, -0.25F));
  view.camera.up = glm::normalize(glm::cross(glm::cross(view.camera.look, vec3(0, 0, 1)), view.camera.look));
  expect_honest(floor, with_target(view, 1.0F / 64.0F), "a floor's texture", {.tone_mapping = ToneMapping::kAgx});
}

// Only pixels with an estimated error are counted. The renderer considers a pixel with equal samples exact.
TEST_F(ErrorTargetTest, EstimatesOfFixedSamplesHoldOf90In100Pixels) {
  TunedRendererOptions options;
  options.aovs.error = true;
  for (const char* name : cases_of<const char*>({"mirrors", "sphereflake", "showcase", "glass"}, 2)) {
    Scene scene = load_scene(std::filesystem::path(PROMIN_SCENES_DIR) / (std::string(name) + ".gltf"));
    light_scene(scene, LightChoice::kAuto);
    Renderer renderer = make_renderer(device(), scene, options);
    View view = view_of(scene, uvec2(40, 30));
    view.samples_per_pixel = 256;
    const Image truth = renderer.render(view).image;
    for (const uint32_t samples : {4U, 15U}) {
      view.samples_per_pixel = samples;
      const RenderResult result = renderer.render(view);
      size_t uneven = 0;
      size_t within = 0;
      double sum = 0.0;
      for (size_t i = 0; i < truth.pixels.size(); ++i) {
        const vec3& estimate = result.aovs.error[i];
        if (estimate == vec3(0.0F)) continue;
        ++uneven;
        within += glm::all(glm::lessThanEqual(glm::abs(result.image.pixels[i] - truth.pixels[i]), estimate)) ? 1 : 0;
        sum += static_cast<double>(std::max({estimate.x, estimate.y, estimate.z}));
      }
      const double share = static_cast<double>(within) / static_cast<double>(uneven);
      std::printf("%-16s %2u spp, %4zu pixels, mean %.4f, %.2f %% within\n", name, samples, uneven,
                  sum / static_cast<double>(uneven), 100.0 * share);
      EXPECT_GE(share, 0.9) << name << " " << samples;
      EXPECT_GE(uneven, truth.pixels.size() / 50) << name;
    }
  }
}

TEST_F(ErrorTargetTest, EstimatesChangeNoBitAndHangOnNoCropPacketOrOtherAov) {
  const world::Scene scene = make_scene_of_everything();
  View view = make_view(uvec2(75, 50));
  view.samples_per_pixel = 20;
  const Image plain = make_renderer(device(), scene).render(view).image;
  TunedRendererOptions options;
  options.aovs.error = true;
  options.packet_size = 1;
  const RenderResult expected = make_renderer(device(), scene, options).render(view);
  EXPECT_TRUE(has_same_bits(plain, expected.image));
  EXPECT_EQ(expected.aovs.error.size(), 75U * 50);
  for (const uint32_t packet_size : cases_of<uint32_t>({4, 2}, 1)) {
    options.packet_size = packet_size;
    options.blocks_per_dispatch = 7;
    EXPECT_EQ(make_renderer(device(), scene, options).render(view).aovs.error, expected.aovs.error) << packet_size;
  }
  options.aovs = options.aovs | AovSet::of_surfaces();
  options.aovs.direct = true;
  options.aovs.cryptomatte = true;
  Renderer renderer = make_renderer(device(), scene, options);
  EXPECT_EQ(renderer.render(view).aovs.error, expected.aovs.error);
  const RenderResult whole = renderer.render(view);
  View crop = view;
  crop.crop = PixelWindow{uvec2(20, 11), uvec2(53, 49)};
  const RenderResult part = renderer.render(crop);
  ASSERT_EQ(part.image.size, uvec2(33, 38));
  for (uint32_t y = 0; y < part.image.size.y; ++y) {
    for (uint32_t x = 0; x < part.image.size.x; ++x) {
      const size_t in_part = size_t{y} * 33 + x;
      const size_t in_whole = size_t{y + 11} * 75 + x + 20;
      ASSERT_EQ(part.image.pixels[in_part], plain.pixels[in_whole]) << x << " " << y;
      ASSERT_EQ(part.aovs.error[in_part], expected.aovs.error[in_whole]) << x << " " << y;
      ASSERT_EQ(part.aovs.position[in_part], whole.aovs.position[in_whole]) << x << " " << y;
      ASSERT_EQ(part.aovs.object_coverage[in_part], whole.aovs.object_coverage[in_whole]) << x << " " << y;
    }
  }
}

TEST_F(ErrorTargetTest, BitsDoNotDependOnPiecesPacketsOrCrops) {
  const world::Scene scene = make_scene_of_everything();
  const View view = with_target(make_view(uvec2(75, 50)), 1.0F / 32.0F, 4, 64);
  TunedRendererOptions options;
  options.with_aovs = true;
  options.packet_size = 1;
  const RenderResult expected = make_renderer(device(), scene, options).render(view);
  EXPECT_GT(expected.error->samples, 5U * 75 * 50);
  for (const uint32_t packet_size : cases_of<uint32_t>({4, 2}, 1)) {
    options.packet_size = packet_size;
    options.blocks_per_dispatch = 7;
    const RenderResult result = make_renderer(device(), scene, options).render(view);
    EXPECT_TRUE(has_same_bits(result.image, expected.image)) << packet_size;
    EXPECT_EQ(result.aovs.error, expected.aovs.error) << packet_size;
    EXPECT_EQ(result.aovs.samples, expected.aovs.samples) << packet_size;
    EXPECT_EQ(result.rays.total(), expected.rays.total()) << packet_size;
  }
  View crop = view;
  crop.crop = PixelWindow{uvec2(20, 11), uvec2(53, 49)};
  const RenderResult part = make_renderer(device(), scene, options).render(crop);
  for (uint32_t y = 0; y < part.image.size.y; ++y) {
    for (uint32_t x = 0; x < part.image.size.x; ++x) {
      ASSERT_EQ(part.image.at(x, y), expected.image.at(x + 20, y + 11)) << x << " " << y;
    }
  }
}

// The rule of claims depends on what samples choose. Kernels for more than that, and lights that are off, change no
// pixel.
TEST_F(ErrorTargetTest, BitsDoNotDependOnFeaturesOfKernels) {
  world::Scene scene = make_scene_of_everything(0);
  scene.lights.resize(1);
  View view = with_target(make_view(uvec2(32, 24)), 1.0F / 16.0F, 4, 64);
  TunedRendererOptions options;
  options.has_error_target = true;
  options.aovs.samples = options.aovs.error = true;
  const auto render = [&](const world::Scene& of) {
    options.mode = view.mode;
    return make_renderer(device(), of, options).render(view);
  };
  const auto expect_same = [](const RenderResult& result, const RenderResult& expected) {
    EXPECT_TRUE(has_same_bits(result.image, expected.image));
    EXPECT_EQ(result.aovs.samples, expected.aovs.samples);
    EXPECT_EQ(result.aovs.error, expected.aovs.error);
  };
  const RenderResult whitted = render(scene);
  options.more_features = all_features();
  expect_same(render(scene), whitted);
  options.more_features = {};

  view.mode.integrator = Integrator::kDirect;
  const RenderResult of_one = render(scene);
  EXPECT_EQ(std::ranges::min(of_one.aovs.samples), 4U);
  // With 17 lights and surfaces that emit light, each sample asks one source.
  scene.lights.resize(17, scene.lights[0]);
  EXPECT_GE(std::ranges::min(render(scene).aovs.samples), 16U);
  for (size_t i = 1; i < scene.lights.size(); ++i) scene.lights[i].is_on = false;
  expect_same(render(scene), of_one);
}

// Camera rays continue behind surfaces that blend.
TEST_F(ErrorTargetTest, AgreesWithManySamplesWhereRaysGoOn) {
  View view = make_view(uvec2(40, 30));
  view.samples_per_pixel = 256;
  Renderer renderer = make_renderer(device(), make_scene_of_alpha());
  const Image truth = renderer.render(view).image;
  const RenderResult result = renderer.render(with_target(view, 1.0F / 32.0F, 4, 64));
  double sum = 0.0;
  for (size_t i = 0; i < truth.pixels.size(); ++i) {
    const vec3 error = glm::abs(result.image.pixels[i] - truth.pixels[i]) /
                       std::max({1.0F, truth.pixels[i].x, truth.pixels[i].y, truth.pixels[i].z});
    sum += static_cast<double>(std::max({error.x, error.y, error.z}));
  }
  EXPECT_LT(sum / static_cast<double>(truth.pixels.size()), 1.0 / 32.0);
}

// A large picture is refined in parts, which leave no seam.
TEST_F(ErrorTargetTest, LargePicturesAreRefinedInParts) {
  const world::Scene scene = make_wires();
  Renderer renderer = make_renderer(device(), scene);
  const View view = with_target(make_board_view(uvec2(300)), 1.0F / 16.0F, 4, 16);
  const Image whole = renderer.render(view).image;
  View crop = view;
  crop.crop = PixelWindow{uvec2(250), uvec2(262)};
  const Image part = renderer.render(crop).image;
  for (uint32_t y = 0; y < 12; ++y) {
    for (uint32_t x = 0; x < 12; ++x) ASSERT_EQ(part.at(x, y), whole.at(x + 250, y + 250));
  }
}

// promin estimates the remaining work again after each stage. The estimate may grow.
TEST_F(ErrorTargetTest, ProgressNeverRunsBackwards) {
  Renderer renderer = make_renderer(device(), make_wires());
  View view = with_target(make_board_view(uvec2(300)), 1.0F / 64.0F, 4, 64);
  for (const bool is_shown : {false, true}) {
    if (is_shown) view.error_target->display.emplace();
    double last = 0.0;
    size_t count = 0;
    renderer.render(view, [&](double fraction) {
      EXPECT_GE(fraction, last) << (is_shown ? "as shown" : "linear");
      last = fraction;
      ++count;
      return true;
    });
    EXPECT_GT(count, 4U);
    EXPECT_LE(last, 1.0);
  }
}

// If no time remains, each pixel has one sample. If there is enough time, the picture reaches the view's target error.
TEST_F(ErrorTargetTest, WithinATimeItIsThePictureOfTheSamplesOrTheErrorThatItNames) {
  const world::Scene scene = make_scene_of_everything(20);
  Renderer renderer = make_renderer(device(), scene);
  View view = with_target(make_view(uvec2(60, 40)), 1.0F / 32.0F);
  view.error_target->display.emplace(DisplayTransform{.tone_mapping = ToneMapping::kNeutral});
  for (const double seconds : {-1.0, 1e-3, 0.2, 1000.0}) {
    const RenderResult result = renderer.render_within(view, seconds);
    View again = view;
    if (result.error) {
      again.error_target->error = result.error->target;
    } else {
      again.error_target.reset();
      again.samples_per_pixel = result.samples_per_pixel;
    }
    if (seconds < 0.01) {
      EXPECT_EQ(result.samples_per_pixel, 1U);
    }
    if (seconds > 100.0) {
      EXPECT_EQ(result.error->target, 1.0F / 32.0F);
    }
    const RenderResult expected = renderer.render(again);
    EXPECT_TRUE(has_same_bits(result.image, expected.image)) << seconds;
    EXPECT_EQ(result.samples_per_pixel, expected.samples_per_pixel);
    if (!result.error) continue;
    EXPECT_EQ(result.error->samples, expected.error->samples);
    EXPECT_EQ(result.error->largest_claim, expected.error->largest_claim);
  }
}

// These AOVs describe rays through the centres of pixels, for any target error.
TEST_F(ErrorTargetTest, AovsAreThoseOfOneSample) {
  const world::Scene scene = make_scene_of_everything(20);
  RendererOptions options;
  options.with_aovs = true;
  Renderer renderer = make_renderer(device(), scene, options);
  const View view = make_view(uvec2(60, 40));
  const Aovs expected = renderer.render(view).aovs;
  const RenderResult result = renderer.render(with_target(view, 1.0F / 16.0F, 4));
  EXPECT_EQ(result.aovs.depth, expected.depth);
  EXPECT_EQ(result.aovs.normal, expected.normal);
  EXPECT_EQ(result.aovs.primitive, expected.primitive);
  EXPECT_EQ(result.aovs.albedo, expected.albedo);
  EXPECT_EQ(expected.samples, std::vector<uint32_t>(2400, 1U));
  EXPECT_EQ(*std::ranges::min_element(result.aovs.samples), 4U);
  EXPECT_GT(*std::ranges::max_element(result.aovs.samples), 4U);
  // The next picture with a fixed number of samples is the same as before.
  EXPECT_TRUE(has_same_bits(renderer.render(view).image, make_renderer(device(), scene).render(view).image));
}

TEST_F(ErrorTargetTest, WhatIsWrongIsRefused) {
  Renderer renderer = make_renderer(device(), make_scene_of_everything(1));
  const View view = make_view(uvec2(8));
  EXPECT_THROW(renderer.render(with_target(view, 0.0F)), UsageError);
  EXPECT_THROW(renderer.render(with_target(view, std::nanf(""))), UsageError);
  EXPECT_THROW(renderer.render(with_target(view, 0.1F, 2)), UsageError);
  EXPECT_THROW(renderer.render(with_target(view, 0.1F, 12)), UsageError);
  EXPECT_THROW(renderer.render(with_target(view, 0.1F, 16, 8)), UsageError);
  EXPECT_THROW(renderer.render(with_target(view, 0.1F, 4, 65536)), UsageError);
  View shown = with_target(view, 0.1F);
  shown.error_target->display.emplace(DisplayTransform{.exposure_ev = std::nanf("")});
  EXPECT_THROW(renderer.render(shown), UsageError);
  View normals = with_target(view, 0.1F);
  normals.mode.debug_view = DebugView::kNormals;
  EXPECT_THROW(renderer.render(normals), UsageError);
  EXPECT_THROW(renderer.render_within(view, 1.0), UsageError);
  EXPECT_THROW(renderer.render_within(with_target(view, 0.1F), std::nan("")), UsageError);
}

}  // namespace
}  // namespace promin::test
