// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check scattered rays (Integrator::kPath): sample by sample against the oracle, in the mean against closed
// forms, and their bits.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "gpu/faulty_shaders.h"
#include "gpu/lit_scenes.h"
#include "gpu/test_scenes.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

/// Balls of all kinds of materials on a floor in front of a red wall, under a sun with an angle and light from all
/// sides.
world::Scene make_room_of_balls() {
  world::Scene scene = test::make_lit_balls();
  scene.materials.push_back(test::make_physical(vec3(0.8F, 0.2F, 0.1F), 0.0F, 1.0F));
  const auto wall = static_cast<uint32_t>(scene.materials.size() - 1);
  scene.objects.push_back({"wall", world::Box{vec3(0.0F, 1.0F, -1.9F), vec3(4.0F, 2.0F, 0.4F)}, wall});
  scene.lights = {test::make_sun(vec3(-0.4F, -1.0F, -0.3F), 2.0F)};
  scene.lights[0].angle = 0.35F;
  scene.environment.ambient = vec3(0.4F, 0.5F, 0.6F);
  return scene;
}

/// A ball of rough metal and a matte one on a matte floor, in light from all sides. Its kernels compile faster.
world::Scene make_plain_room() {
  world::Scene scene;
  scene.materials = {test::make_physical(vec3(0.8F, 0.7F, 0.6F), 0.0F, 0.5F),
                     test::make_physical(vec3(0.9F, 0.7F, 0.4F), 1.0F, 0.3F)};
  scene.objects = {{"floor", world::Sphere{vec3(0.0F, -50.0F, 0.0F), 50.0F}, 0},
                   {"metal", world::Sphere{vec3(-0.6F, 0.6F, 0.0F), 0.6F}, 1},
                   {"ball", world::Sphere{vec3(0.7F, 0.6F, 0.0F), 0.6F}, 0}};
  scene.environment.ambient = vec3(1.0F, 0.9F, 0.8F);
  return scene;
}

/// The room of balls with glass balls: smooth, rough, and a rough thin one.
world::Scene make_room_of_glass() {
  world::Scene scene = make_room_of_balls();
  for (uint32_t i = 0; i < 3; ++i) {
    Material glass = test::make_physical(vec3(0.9F, 0.95F, 0.8F), 0.0F, i == 0 ? 0.0F : 0.4F);
    auto& model = std::get<MetallicRoughness>(glass.model);
    model.transmission = 0.9F;
    model.thickness = i == 2 ? 0.0F : 1.0F;
    scene.materials.push_back(glass);
    scene.objects[i + 1].material = static_cast<uint32_t>(scene.materials.size() - 1);
  }
  return scene;
}

View make_path_view(uint32_t depth = 3, uvec2 size = uvec2(32, 24)) {
  View view = test::make_direct_view(size);
  view.mode.integrator = Integrator::kPath;
  view.max_depth = depth;
  return view;
}

/// A white surface without highlights that scatters this fraction of light.
Material make_lambert(float albedo) {
  Material material = test::make_physical(vec3(albedo), 0.0F, 1.0F);
  std::get<MetallicRoughness>(material.model).specular = 0.0F;
  return material;
}

class ScatteringTest : public test::SampledLightTest {
 protected:
  static oracle::PictureReport compare(const world::Scene& scene, const View& view, const Image& image) {
    // The oracle is unsure about more pixels, because faces of glass multiply the errors of directions.
    const oracle::PictureBounds bounds{.color_mean = 2e-5L, .unsure_share = 0.01};
    return report_of(scene, oracle::render(scene, view), image, bounds);
  }
  /// Compares the first sample of each pixel.
  static void expect_samples(const world::Scene& scene, View view) {
    view.seed = 7;
    EXPECT_TRUE(compare(scene, view, renderer_of(scene).render(view).image).passes());
  }
};

TEST_F(ScatteringTest, EachSampleIsTheOracles) {
  expect_samples(make_room_of_balls(), make_path_view());
}

TEST_F(ScatteringTest, EachSampleThroughGlassIsTheOracles) {
  expect_samples(make_room_of_glass(), make_path_view(5));
}

TEST_F(ScatteringTest, EachSampleUnderASkyIsTheOracles) {
  world::Scene scene = make_room_of_balls();
  scene.environment.sky = Studio{0.3F};
  expect_samples(scene, make_path_view());
}

// Rays that metal scatters see a part of the lamp's light, and the source contributes the rest.
TEST_F(ScatteringTest, EachSampleWithAGlowingBallIsTheOracles) {
  world::Scene scene = make_room_of_balls();
  Material lamp = make_lambert(0.5F);
  lamp.emissive = vec3(4.0F, 3.0F, 2.0F);
  scene.materials.push_back(lamp);
  scene.objects.push_back(
      {"lamp", world::Sphere{vec3(0.2F, 1.4F, 0.4F), 0.25F}, static_cast<uint32_t>(scene.materials.size() - 1)});
  expect_samples(scene, make_path_view());
}

// A density that is off by 2 % is seen, and so are other faults.
TEST_F(ScatteringTest, FaultsAreSeen) {
  for (const char* fault :
       test::cases_of<const char*>({"scattering_density_off", "scattering_cosine_left_out", "scattering_unshuffled",
                                    "facets_unmasked", "roughness_unbounded"},
                                   2)) {
    const world::Scene scene = make_plain_room();
    const View view = make_path_view();
    const test::FaultyShaders faulty(fault);
    TunedRendererOptions options;
    options.shaders = faulty.shaders();
    EXPECT_FALSE(compare(scene, view, renderer_of(scene, options).render(view).image).passes()) << fault;
  }
}

// Without bounces, there is only direct light.
TEST_F(ScatteringTest, WithoutBouncesLightIsDirect) {
  const world::Scene scene = make_plain_room();
  View view = make_path_view(0);
  const Image scattered = renderer_of(scene).render(view).image;
  view.mode.integrator = Integrator::kDirect;
  EXPECT_TRUE(test::has_same_bits(scattered, renderer_of(scene).render(view).image));
}

// Inside a closed box whose walls emit e and scatter the fraction r, light is e (1 + r + r^2 + ...), with a term for
// each ray. Planes are no sources, so that rays find their light in each sample. The faces of a box are sources. They
// add the term of one further ray, and the mean has the closed form.
TEST_F(ScatteringTest, AClosedBoxThatEmitsHasItsClosedForm) {
  world::Scene scene;
  scene.materials = {make_lambert(0.6F)};
  scene.materials[0].emissive = vec3(0.5F, 1.0F, 2.0F);
  const vec3 half_size(3.0F, 2.0F, 5.0F);
  const auto sum_of = [](uint32_t terms) { return (1.0 - std::pow(0.6, terms)) / 0.4; };
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      vec3 normal(0.0F);
      normal[axis] = -side;
      scene.objects.push_back({"wall", world::Plane{-half_size[axis] * normal, normal}, 0});
    }
  }
  for (const uint32_t depth : {0U, 1U, 6U}) {
    View view = make_path_view(depth, uvec2(16));
    view.camera.eye = vec3(0.2F, 0.1F, 0.3F);
    for (const vec3& pixel : renderer_of(scene).render(view).image.pixels) {
      EXPECT_NEAR(pixel.x, 0.5 * sum_of(depth + 1), 1e-5) << depth;
      EXPECT_NEAR(pixel.z, 2.0 * sum_of(depth + 1), 1e-5) << depth;
    }
  }
  scene.objects = {{"box", world::Box{vec3(0.0F), half_size}, 0}};
  View view = make_path_view(2, uvec2(16));
  view.camera.eye = vec3(0.2F, 0.1F, 0.3F);
  view.samples_per_pixel = 64;
  EXPECT_NEAR(mean_of(scene, view).x, 0.5 * sum_of(4), 0.01);
}

// White bodies of all kinds under a white sky are white, whether the sky is a source or a ball of light around them
// that rays hit.
TEST_F(ScatteringTest, WhiteBodiesAreWhite) {
  world::Scene scene;
  scene.objects = {{"ball", world::Sphere{vec3(0.0F), 1.0F}, 0}};
  View view = make_path_view(1, uvec2(16));
  view.camera.eye = vec3(0, 0, 4);
  view.camera.look = vec3(0, 0, -1);
  view.camera.up = vec3(0, 1, 0);
  view.camera.yfov = 0.3F;
  view.samples_per_pixel = 64;
  for (const bool is_hit : {false, true}) {
    Material shell = test::make_unlit(vec3(1.0F));
    scene.materials.assign(2, shell);
    scene.objects.resize(1);
    if (is_hit) scene.objects.push_back({"shell", world::Sphere{vec3(0.0F), 50.0F}, 1});
    scene.environment.ambient = vec3(is_hit ? 0.0F : 1.0F);
    for (const float metallic : {0.0F, 1.0F}) {
      for (const float roughness : {0.0F, 0.15F, 0.3F, 0.6F, 1.0F}) {
        scene.materials[0] = test::make_physical(vec3(1.0F), metallic, roughness);
        EXPECT_NEAR(mean_of(scene, view).x, 1.0, 0.02) << is_hit << metallic << roughness;
      }
    }
  }
}

// A patch of the floor that a spot lights sends as much light by way of the wall as the wall's patch does by way of the
// floor, if eye and light change places. Both are at the same distance from their patch.
TEST_F(ScatteringTest, TwoPatchesAreReciprocal) {
  world::Scene scene;
  scene.materials = {make_lambert(0.8F)};
  scene.objects = {{"floor", world::Box{vec3(0.0F, -1.0F, 0.0F), vec3(40.0F, 1.0F, 40.0F)}, 0},
                   {"wall", world::Box{vec3(0.0F, 20.0F, -41.0F), vec3(40.0F, 20.0F, 41.0F)}, 0}};
  const vec3 on_floor(0.3F, 0.0F, 1.5F);
  const vec3 on_wall(0.0F, 0.7F, 0.0F);
  const auto seen = [&](const vec3& lit, const vec3& lit_normal, const vec3& at, const vec3& normal) {
    Light spot;
    spot.kind = LightKind::kSpot;
    spot.position = lit + 0.5F * lit_normal;
    spot.direction = -lit_normal;
    spot.inner_cone_angle = 0.2F;
    spot.outer_cone_angle = 0.2F;
    scene.lights = {spot};
    View view = make_path_view(1, uvec2(32));
    view.camera.eye = at + 0.5F * normal;
    view.camera.look = -normal;
    view.camera.up = vec3(1, 0, 0);
    view.camera.yfov = 0.4F;
    view.samples_per_pixel = 512;
    return mean_of(scene, view).x;
  };
  const double by_wall = seen(on_floor, vec3(0, 1, 0), on_wall, vec3(0, 0, 1));
  const double by_floor = seen(on_wall, vec3(0, 0, 1), on_floor, vec3(0, 1, 0));
  EXPECT_NEAR(by_floor / by_wall, 1.0, 0.02);
  EXPECT_GT(by_floor, 1e-4);
}

TEST_F(ScatteringTest, EveryWayOfTracingHasTheSameBits) {
  const world::Scene scene = make_plain_room();
  View view = make_path_view();
  view.samples_per_pixel = 3;
  expect_same_bits(scene, view);
}

}  // namespace
}  // namespace promin
