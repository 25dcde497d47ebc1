// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check the environment as a source of light (Integrator::kDirect): sample by sample against the oracle, in
// the mean against closed forms, and its bits.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "device_scene/sampling.h"
#include "device_scene/scrambled_points.h"
#include "gpu/faulty_shaders.h"
#include "gpu/lit_scenes.h"
#include "gpu/test_scenes.h"
#include "oracle/sky_light.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

/// A white panorama, a quarter of which is dark, with one bright texel.
Panorama make_sunny_panorama(float sun) {
  auto image = std::make_shared<Image>();
  image->size = uvec2(256, 128);
  image->pixels.assign(size_t{256} * 128, vec3(0.4F, 0.5F, 0.7F));
  for (uint32_t y = 64; y < 128; ++y) {
    for (uint32_t x = 0; x < 256; ++x) image->pixels[y * 256 + x] = vec3(0.1F, 0.08F, 0.05F);
  }
  image->pixels[size_t{30} * 256 + 90] = vec3(sun);
  return {image};
}

class SkyLightTest : public test::SampledLightTest {
 protected:
  static oracle::PictureReport compare(const world::Scene& scene, const oracle::Picture& truth, const Image& image) {
    // Densities that are off by 2 % change few pixels of smooth surfaces.
    return report_of(scene, truth, image, {.color_mean = 2e-5L});
  }
  /// Compares the first sample of each pixel.
  static void expect_samples(const world::Scene& scene, View view) {
    view.seed = 7;
    EXPECT_TRUE(compare(scene, oracle::render(scene, view), renderer_of(scene).render(view).image).passes());
  }
};

TEST_F(SkyLightTest, EachSampleOfAmbientLightIsTheOracles) {
  world::Scene scene = test::make_lit_balls();
  scene.environment.ambient = vec3(0.9F, 0.7F, 0.5F);
  expect_samples(scene, test::make_direct_view());
}

TEST_F(SkyLightTest, EachSampleOfAGradientIsTheOracles) {
  world::Scene scene = test::make_lit_balls();
  scene.environment.sky = GradientSky();
  scene.lights = {test::make_sun(vec3(-0.4F, -1.0F, -0.3F), 0.4F)};
  scene.lights[0].angle = 0.35F;
  expect_samples(scene, test::make_direct_view());
}

TEST_F(SkyLightTest, EachSampleOfAStudioIsTheOracles) {
  world::Scene scene = test::make_lit_balls();
  scene.environment.sky = Studio{0.3F};
  scene.environment.rotation = 0.5F;
  scene.environment.intensity = 0.8F;
  View view = test::make_direct_view();
  view.camera.aperture_radius = 0.1F;
  view.camera.focus_distance = 4.0F;
  expect_samples(scene, view);
}

TEST_F(SkyLightTest, EachSampleOfASunnyPanoramaIsTheOracles) {
  world::Scene scene = test::make_lit_balls();
  scene.environment.sky = make_sunny_panorama(300.0F);
  expect_samples(scene, test::make_direct_view());
}

// A density that is off by 2 % is seen, and so are other faults.
TEST_F(SkyLightTest, FaultsAreSeen) {
  for (const char* fault : test::cases_of<const char*>(
           {"sky_density_off", "dome_density_off", "sky_lobes_left_out", "sky_squares_swapped", "sky_horizon_hard"},
           1)) {
    world::Scene scene = test::make_lit_balls();
    if (std::string(fault).starts_with("dome")) {
      scene.environment.ambient = vec3(1.0F);
    } else {
      scene.environment.sky = Studio{};
    }
    const View view = test::make_direct_view();
    const test::FaultyShaders faulty(fault);
    TunedRendererOptions options;
    options.shaders = faulty.shaders();
    const Image image = renderer_of(scene, options).render(view).image;
    EXPECT_FALSE(compare(scene, oracle::render(scene, view), image).passes()) << fault;
  }
}

// The densities of the oracle, and so those of the device, integrate to 1 minus the chance of a square all of whose
// quarters lie below the horizon. Samples that choose such a square add nothing.
TEST_F(SkyLightTest, DensitiesIntegrateToOne) {
  Environment environment;
  environment.sky = Studio{};
  const oracle::SkyLight sky(environment);
  constexpr int kSide = 256;
  for (const dvec3& direction : {dvec3(0, 1, 0), dvec3(1, 0.2, -0.4), dvec3(-0.3, -0.9, 0.5)}) {
    const oracle::Vector normal = glm::normalize(oracle::Vector(direction));
    double sum = 0.0;
    for (int i = 0; i < kSide; ++i) {
      const double y = 2.0 * (i + 0.5) / kSide - 1.0;
      for (int j = 0; j < 2 * kSide; ++j) {
        const double azimuth = std::numbers::pi * (j + 0.5) / kSide;
        const double across = std::sqrt(1.0 - y * y);
        sum += static_cast<double>(
            sky.density(normal, oracle::Vector(across * std::sin(azimuth), y, across * std::cos(azimuth))));
      }
    }
    const double integral = sum * 4.0 * std::numbers::pi / (2.0 * kSide * kSide);
    EXPECT_LT(integral, 1.002);
    EXPECT_GT(integral, 0.99);
  }
}

// A floor under light of one colour from everywhere has its albedo times that colour, in each sample.
TEST_F(SkyLightTest, ADomeOfOneColourHasNoNoise) {
  world::Scene scene = test::make_open_floor(vec3(0.5F, 0.25F, 1.0F));
  scene.environment.ambient = vec3(0.8F, 0.6F, 1.0F);
  View view = test::make_point_view(vec3(0.0F));
  view.samples_per_pixel = 1;
  for (const vec3& pixel : renderer_of(scene).render(view).image.pixels) {
    EXPECT_NEAR(pixel.x, 0.4F, 1e-6F);
    EXPECT_NEAR(pixel.y, 0.15F, 1e-6F);
    EXPECT_NEAR(pixel.z, 1.0F, 1e-6F);
  }
}

// White balls of all roughness reflect as much light of a uniform sky as without shadows.
TEST_F(SkyLightTest, UniformSkiesLightConvexBodiesAsWithoutShadows) {
  world::Scene scene;
  scene.objects = {{"ball", world::Sphere{vec3(0.0F), 1.0F}, 0}};
  GradientSky sky;
  sky.top = sky.horizon = sky.bottom = vec3(1.0F);
  View view = test::make_direct_view(uvec2(16));
  view.camera.eye = vec3(0, 0, 4);
  view.camera.look = vec3(0, 0, -1);
  view.camera.up = vec3(0, 1, 0);
  view.camera.yfov = 0.3F;
  view.samples_per_pixel = 64;
  for (const bool is_mapped : {false, true}) {
    scene.environment = {};
    if (is_mapped) {
      scene.environment.sky = sky;
    } else {
      scene.environment.ambient = vec3(1.0F);
    }
    for (const float metallic : {0.0F, 1.0F}) {
      for (const float roughness : {0.0F, 0.25F, 0.5F, 1.0F}) {
        scene.materials = {test::make_physical(vec3(1.0F), metallic, roughness)};
        view.mode.integrator = Integrator::kDirect;
        const double soft = mean_of(scene, view).x;
        view.mode.integrator = Integrator::kWhitted;
        EXPECT_NEAR(soft / mean_of(scene, view).x, 1.0, 0.01) << is_mapped << metallic << roughness;
      }
    }
  }
}

// The floor beside a long wall sees (1 + cos a) / 2 of a uniform sky, where a is the elevation of the wall's upper
// edge. Below a disc it sees 1 - r^2 / (r^2 + h^2).
TEST_F(SkyLightTest, OcclusionHasItsClosedForm) {
  world::Scene scene = test::make_open_floor();
  scene.environment.ambient = vec3(1.0F);
  scene.objects.push_back({"wall", world::Box{vec3(-1.0F, 0.5F, 0.0F), vec3(1.0F, 0.5F, 400.0F)}, 0});
  for (const double distance : {0.1, 0.5, 2.0}) {
    const double elevation = std::atan2(1.0, distance);
    const View view = test::make_point_view(vec3(static_cast<float>(distance), 0.0F, 0.0F));
    EXPECT_NEAR(mean_of(scene, view).x, 0.5 * (1.0 + std::cos(elevation)), 0.002) << distance;
  }
  world::Cylinder disc;
  disc.center = vec3(0.0F, 1.0F, 0.0F);
  disc.axis = vec3(0, 1, 0);
  disc.half_height = 1e-3F;
  disc.radius = 0.8F;
  scene.objects[1] = {"disc", disc, 0};
  EXPECT_NEAR(mean_of(scene, test::make_point_view(vec3(0.0F))).x, 1.0 - 0.64 / (0.64 + 0.999 * 0.999), 0.002);
}

// A floor under a sky has the integral of the radiance times the cosine.
TEST_F(SkyLightTest, FloorsHaveTheSkysIrradiance) {
  for (const float sun : {0.0F, 300.0F, 60000.0F}) {
    world::Scene scene = test::make_open_floor();
    scene.environment.sky = make_sunny_panorama(sun);
    const oracle::SkyLight sky(scene.environment);
    constexpr int kSide = 1024;
    dvec3 sum(0.0);
    for (int i = 0; i < kSide; ++i) {
      // Equal steps of the squared sine are equal parts of a disc.
      const double y = std::sqrt((i + 0.5) / kSide);
      const double across = std::sqrt(1.0 - y * y);
      for (int j = 0; j < 4 * kSide; ++j) {
        const double azimuth = 2.0 * std::numbers::pi * (j + 0.5) / (4 * kSide);
        sum += dvec3(sky.radiance(oracle::Vector(across * std::sin(azimuth), y, across * std::cos(azimuth))));
      }
    }
    const dvec3 expected = sum / (4.0 * kSide * kSide);
    const dvec3 got = mean_of(scene, test::make_point_view(vec3(0.0F)));
    // The interpolated radiance of a single texel varies within its square, which is noise.
    const double noise = sun > 1000.0F ? 0.01 : 0.004;
    EXPECT_NEAR(got.x / expected.x, 1.0, noise) << sun;
    EXPECT_NEAR(got.z / expected.z, 1.0, noise) << sun;
  }
}

// A sky without light, a dark one with a single texel of 10^5, and a very dark one give finite pictures.
TEST_F(SkyLightTest, ExtremeSkiesGiveFinitePictures) {
  world::Scene scene = test::make_lit_balls();
  Renderer renderer = renderer_of(scene);
  View view = test::make_direct_view();
  const auto image = std::make_shared<Image>();
  image->size = uvec2(64, 32);
  image->pixels.assign(size_t{64} * 32, vec3(0.0F));
  for (const float value : {0.0F, 1e5F, 1e15F, 1e-30F}) {
    auto changed = std::make_shared<Image>(*image);
    changed->pixels[size_t{8} * 64 + 20] = vec3(value);
    Environment environment;
    environment.sky = Panorama{changed};
    renderer.set_environment(environment);
    for (const vec3& pixel : renderer.render(view).image.pixels) {
      for (int i = 0; i < 3; ++i) ASSERT_TRUE(std::isfinite(pixel[i]) && pixel[i] >= 0.0F) << value;
      if (value == 0.0F) {
        ASSERT_EQ(pixel, vec3(0.0F));
      }
    }
  }
}

TEST_F(SkyLightTest, EveryWayOfTracingHasTheSameBits) {
  world::Scene scene = test::make_lit_balls();
  scene.environment.sky = Studio{};
  View view = test::make_direct_view();
  view.samples_per_pixel = 3;
  expect_same_bits(scene, view);
}

// A renderer switches between both integrators, and lights and environments may change in between.
TEST_F(SkyLightTest, IntegratorsAndEnvironmentsCanChange) {
  world::Scene scene = test::make_lit_balls();
  scene.environment.sky = Studio{};
  View view = test::make_direct_view();
  Renderer renderer = renderer_of(scene);
  const Image soft = renderer.render(view).image;
  view.mode.integrator = Integrator::kWhitted;
  const Image bright = renderer.render(view).image;
  EXPECT_FALSE(test::has_same_bits(soft, bright));
  EXPECT_TRUE(test::has_same_bits(renderer_of(scene).render(view).image, bright));
  renderer.set_environment({});
  scene.lights = {test::make_sun(vec3(0.2F, -1.0F, 0.1F), 0.4F)};
  renderer.set_lights(scene.lights);
  for (const vec3& ambient : {vec3(0.0F), vec3(0.5F)}) {
    Environment environment;
    environment.ambient = scene.environment.ambient = ambient;
    scene.environment.sky = std::monostate();
    renderer.set_environment(environment);
    for (const Integrator integrator : {Integrator::kWhitted, Integrator::kDirect}) {
      view.mode.integrator = integrator;
      EXPECT_TRUE(test::has_same_bits(renderer_of(scene).render(view).image, renderer.render(view).image));
    }
  }
}

}  // namespace
}  // namespace promin
