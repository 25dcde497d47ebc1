// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check surfaces that show only shadows (Unlit::catches_shadows) and pictures of occlusion.
#include <gtest/gtest.h>

#include <cmath>

#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "gpu/ways_of_tracing.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

constexpr float kBallRadius = 0.5F;
constexpr float kBallHeight = 0.8F;

/// A ball over a ground that catches shadows, under ambient light of 0.5 and a sun.
world::Scene make_caught_scene(float sun) {
  world::Scene scene;
  Phong phong;
  phong.ambient = phong.diffuse = vec3(0.6F);
  Unlit catcher;
  catcher.catches_shadows = true;
  // In a scene of Phong's materials, a sun of power 1 counts as much as ambient light of 1.
  catcher.color = vec3(0.5F + sun);
  scene.materials = {{.name = "", .model = phong}, {.name = "", .model = catcher}};
  scene.objects = {{"ball", world::Sphere{vec3(0.0F, kBallHeight, 0.0F), kBallRadius}, 0},
                   {"ground", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 1}};
  scene.environment.ambient = vec3(0.5F);
  scene.environment.background = vec3(0.3F, 0.6F, 0.9F);
  if (sun > 0.0F) scene.lights = {test::make_sun(vec3(0, -1, 0), sun)};
  return scene;
}

/// Returns a view from below the ball on a point of the ground.
View make_ground_view(float x) {
  View view;
  view.size = uvec2(8);
  view.camera.eye = vec3(x, 0.1F, 0.0F);
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.camera.yfov = 0.002F;
  view.samples_per_pixel = 256;
  view.mode.integrator = Integrator::kDirect;
  return view;
}

class GroundTest : public test::DeviceTest {
 protected:
  static RenderResult render(const world::Scene& scene, const View& view, const AovSet& aovs = {}) {
    TunedRendererOptions options;
    options.aovs = aovs;
    return make_renderer(device(), scene, options).render(view);
  }
  static dvec3 mean_of(const Image& image) {
    dvec3 sum(0.0);
    for (const vec3& pixel : image.pixels) sum += dvec3(pixel);
    return sum / static_cast<double>(image.pixels.size());
  }
};

// A ball of radius r at the height h covers the fraction r^2 / h^2 of uniform light, and the whole sun.
TEST_F(GroundTest, ShadowsHaveTheFractionOfMissingLight) {
  const double covered = std::pow(static_cast<double>(kBallRadius / kBallHeight), 2.0);
  for (const float sun : {0.0F, 0.7F}) {
    const world::Scene scene = make_caught_scene(sun);
    const double arriving = 0.5 * (1.0 - covered) / (0.5 + static_cast<double>(sun));
    const dvec3 seen = mean_of(render(scene, make_ground_view(0.0F)).image);
    EXPECT_NEAR(seen.x / 0.3, arriving, 0.003) << sun;
    EXPECT_NEAR(seen.z / 0.9, arriving, 0.003) << sun;
    AovSet aovs;
    aovs.alpha = true;
    const RenderResult cut_out = render(scene, make_ground_view(0.0F), aovs);
    double alpha = 0.0;
    for (const float a : cut_out.aovs.alpha) alpha += static_cast<double>(a) / 64.0;
    EXPECT_NEAR(alpha, 1.0 - arriving, 0.003) << sun;
    EXPECT_NEAR(mean_of(cut_out.image).x, 0.0, 1e-5) << sun;
  }
}

// Where nothing is in front of the light, the ground is invisible in each sample, for any number of sources.
TEST_F(GroundTest, OutsideOfShadowsTheGroundIsInvisible) {
  world::Scene scene = make_caught_scene(0.7F);
  // The ball is too far away to be in the picture.
  std::get<world::Sphere>(scene.objects[0].shape).center = vec3(0.0F, 1e5F, 0.0F);
  std::get<world::Sphere>(scene.objects[0].shape).radius = 0.01F;
  scene.lights.front().angle = 0.2F;
  View view = make_ground_view(3.0F);
  view.samples_per_pixel = 1;
  for (const bool has_shadows : {true, false}) {
    view.mode.has_shadows = has_shadows;
    for (const vec3& pixel : render(scene, view).image.pixels) {
      EXPECT_NEAR(pixel.x, 0.3F, 1e-6F);
      EXPECT_NEAR(pixel.y, 0.6F, 1e-6F);
    }
  }
}

// Light from below the ground arrives at objects, as without a ground, whether or not surfaces transmit light.
TEST_F(GroundTest, TheGroundBlocksNoLight) {
  world::Scene scene = make_caught_scene(0.7F);
  scene.lights.front().direction = vec3(0, 1, 0);
  scene.lights.front().angle = 0.2F;
  View view;
  view.size = uvec2(16);
  view.camera.eye = vec3(0.0F, kBallHeight, 3.0F);
  view.camera.look = vec3(0, 0, -1);
  view.camera.up = vec3(0, 1, 0);
  view.camera.yfov = 0.2F;
  view.samples_per_pixel = 2;
  for (const bool has_glass : {false, true}) {
    if (has_glass) {
      Phong glass;
      glass.transmission = vec3(1.0F);
      scene.materials.push_back({.name = "", .model = glass});
      scene.objects.push_back({"window", world::Sphere{vec3(0.0F, 50.0F, 0.0F), 1.0F}, 2});
    }
    for (const Integrator integrator : {Integrator::kWhitted, Integrator::kDirect}) {
      view.mode.integrator = integrator;
      world::Scene floating = scene;
      floating.objects.erase(floating.objects.begin() + 1);
      const Image expected = make_renderer(device(), floating).render(view).image;
      EXPECT_TRUE(test::has_same_bits(make_renderer(device(), scene).render(view).image, expected)) << has_glass;
      // The lower half of the ball is brighter.
      EXPECT_GT(expected.pixels[15 * 16 + 8].x, expected.pixels[8].x + 0.1F);
    }
  }
  // The ground occludes what is above it nevertheless.
  view.mode = {.debug_view = DebugView::kOcclusion};
  view.samples_per_pixel = 64;
  const Image occluded = make_renderer(device(), scene).render(view).image;
  EXPECT_LT(occluded.pixels[15 * 16 + 8].x, occluded.pixels[8].x - 0.1F);
}

// With Whitted's integrator only lights cast shadows.
TEST_F(GroundTest, LightsCastHardShadowsWithoutTheSky) {
  View view = make_ground_view(0.0F);
  view.mode.integrator = Integrator::kWhitted;
  EXPECT_NEAR(mean_of(render(make_caught_scene(0.7F), view).image).y, 0.6 * 0.5 / 1.2, 1e-5);
}

// Mirrors show the ground too: what is behind it, with the shadow. Each way of tracing has the same bits.
TEST_F(GroundTest, EveryWayOfTracingHasTheSameBits) {
  world::Scene scene = make_caught_scene(0.7F);
  std::get<Phong>(scene.materials[0].model).reflection = vec3(0.5F);
  View view;
  view.size = uvec2(40, 30);
  view.camera.eye = vec3(0.0F, 1.0F, 3.0F);
  view.camera.look = glm::normalize(vec3(0.0F, -0.2F, -1.0F));
  view.camera.up = glm::normalize(glm::cross(glm::cross(view.camera.look, vec3(0, 1, 0)), view.camera.look));
  view.samples_per_pixel = 2;
  view.mode.integrator = Integrator::kDirect;
  const Image expected = make_renderer(device(), scene).render(view).image;
  for (const TunedRendererOptions& way : test::ways_of_tracing()) {
    EXPECT_TRUE(test::has_same_bits(make_renderer(device(), scene, way).render(view).image, expected));
  }
  // A mirror of the sky's lower half is darker than the background.
  AovSet aovs;
  aovs.reflection = true;
  const RenderResult parts = render(scene, view, aovs);
  float least = 1.0F;
  for (size_t i = 0; i < parts.aovs.reflection.size(); ++i) {
    const vec3& mirrored = parts.aovs.reflection[i];
    EXPECT_LE(mirrored.z, 0.5F * 0.9F + 1e-5F);
    if (mirrored.z > 0.0F) least = std::min(least, mirrored.z);
  }
  EXPECT_LT(least, 0.5F * 0.9F * 0.9F);
}

// A disc of radius r at the height h covers r^2 / (r^2 + h^2) of the directions, weighted by their cosines.
TEST_F(GroundTest, OcclusionHasItsClosedFormUpToItsDistance) {
  world::Scene scene;
  scene.materials = {Material{}};
  world::Cylinder disc;
  disc.center = vec3(0.0F, 1.0F, 0.0F);
  disc.axis = vec3(0, 1, 0);
  disc.half_height = 1e-3F;
  disc.radius = 0.8F;
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}, {"disc", disc, 0}};
  View view = make_ground_view(0.0F);
  view.mode = {.debug_view = DebugView::kOcclusion};
  const double open = 1.0 - 0.64 / (0.64 + 0.999 * 0.999);
  EXPECT_NEAR(mean_of(render(scene, view).image).x, open, 0.003);
  view.occlusion_distance = 0.9F;
  EXPECT_EQ(mean_of(render(scene, view).image).x, 1.0);
  // The distance is measured along the rays.
  view.occlusion_distance = 1.1F;
  EXPECT_NEAR(mean_of(render(scene, view).image).x, std::pow(0.999 / 1.1, 2.0), 0.003);
  // The AOV has the same values, also beside a picture with an error target. Rays that miss count as open.
  AovSet aovs;
  aovs.ambient_occlusion = true;
  view.mode = {};
  view.occlusion_distance = 0.0F;
  for (const bool is_refined : {false, true}) {
    if (is_refined) view.error_target = ErrorTarget{};
    double sum = 0.0;
    const RenderResult result = render(scene, view, aovs);
    for (const float share : result.aovs.ambient_occlusion) sum += static_cast<double>(share) / 64.0;
    EXPECT_NEAR(sum, open, 0.006) << is_refined;
  }
  view.camera.look = vec3(0, 1, 0);
  view.camera.eye = vec3(5.0F, 3.0F, 0.0F);
  EXPECT_EQ(render(scene, view, aovs).aovs.ambient_occlusion.front(), 1.0F);
}

}  // namespace
}  // namespace promin
