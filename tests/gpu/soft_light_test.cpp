// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check lights with a size and the lens: sample by sample against the oracle, in the mean against closed
// forms, and their bits.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "device_scene/sampling.h"
#include "device_scene/scrambled_points.h"
#include "gpu/faulty_shaders.h"
#include "gpu/lit_scenes.h"
#include "gpu/test_scenes.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

constexpr uvec2 kSoftSize(40, 30);

Material make_matte(const vec3& color, float mirror = 0.0F) {
  Phong phong;
  phong.ambient = vec3(0.0F);
  phong.diffuse = color;
  phong.reflection = vec3(mirror);
  return {.name = "", .model = phong};
}

Light make_ball(const vec3& position, float radius, float power) {
  Light light;
  light.position = position;
  light.radius = radius;
  light.diffuse = light.specular = vec3(power);
  light.attenuation = Attenuation::kInverseSquare;
  return light;
}

/// A floor with balls, one of which is a mirror, under a ball of light, a spot with a radius, a sun of 20 degrees and a
/// point.
world::Scene make_soft_scene() {
  world::Scene scene;
  scene.materials = {make_matte(vec3(0.8F, 0.7F, 0.6F)), make_matte(vec3(0.3F, 0.5F, 0.8F)),
                     make_matte(vec3(0.1F), 0.8F)};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0},
                   {"ball", world::Sphere{vec3(-0.8F, 0.5F, 0.0F), 0.5F}, 1},
                   {"mirror", world::Sphere{vec3(0.7F, 0.6F, -0.3F), 0.6F}, 2}};
  Light spot = make_ball(vec3(1.5F, 2.5F, 1.5F), 0.3F, 6.0F);
  spot.kind = LightKind::kSpot;
  spot.direction = glm::normalize(vec3(-0.5F, -1.0F, -0.5F));
  spot.inner_cone_angle = 0.3F;
  spot.outer_cone_angle = 0.5F;
  Light sun = test::make_sun(vec3(-0.4F, -1.0F, -0.3F), 0.4F);
  sun.angle = 0.35F;
  Light point = make_ball(vec3(-2.0F, 2.0F, 1.0F), 0.0F, 1.0F);
  scene.lights = {make_ball(vec3(-1.2F, 2.0F, 0.8F), 0.6F, 3.0F), spot, sun, point};
  return scene;
}

/// The same floor and balls under a rectangle and a disk, which touch the region where points are chosen by area, and
/// two small ones.
world::Scene make_flat_scene() {
  world::Scene scene = make_soft_scene();
  scene.lights.clear();
  const auto add = [&](LightKind kind, const vec3& position, const vec3& direction, const vec2& size, float radiance) {
    Light light = make_ball(position, 0.0F, radiance);
    light.kind = kind;
    light.direction = glm::normalize(direction);
    light.right = glm::normalize(glm::cross(light.direction, vec3(0.2F, 0.3F, 1.0F)));
    light.size = size;
    scene.lights.push_back(light);
  };
  add(LightKind::kRect, vec3(-1.0F, 1.8F, 0.9F), vec3(0.3F, -1.0F, -0.2F), vec2(1.2F, 0.7F), 3.0F);
  add(LightKind::kDisk, vec3(1.4F, 1.5F, 0.8F), vec3(-0.4F, -1.0F, -0.4F), vec2(0.9F), 3.0F);
  add(LightKind::kRect, vec3(-2.0F, 3.0F, 1.5F), vec3(0.6F, -1.0F, -0.4F), vec2(0.2F, 0.1F), 60.0F);
  add(LightKind::kDisk, vec3(0.0F, 3.5F, -1.0F), vec3(0.0F, -1.0F, 0.3F), vec2(0.15F), 60.0F);
  return scene;
}

View make_soft_view(uvec2 size = kSoftSize) {
  View view;
  view.size = size;
  view.camera.eye = vec3(0.0F, 1.6F, 4.0F);
  view.camera.look = glm::normalize(vec3(0.0F, -0.3F, -1.0F));
  view.camera.up = glm::normalize(glm::cross(glm::cross(view.camera.look, vec3(0, 1, 0)), view.camera.look));
  view.max_depth = 3;
  return view;
}

class SoftLightTest : public test::SampledLightTest {
 protected:
  static oracle::PictureReport compare(const world::Scene& scene, const oracle::Picture& truth, const Image& image) {
    // Densities that are off by 2 % change few pixels of smooth surfaces.
    return report_of(scene, truth, image, {.color_mean = 1e-6L});
  }
  /// Compares the first sample of each pixel, for several seeds.
  static void expect_samples(const world::Scene& scene, View view) {
    Renderer renderer = renderer_of(scene);
    for (const uint32_t seed : {0U, 1U, 4294967295U}) {
      view.seed = seed;
      EXPECT_TRUE(compare(scene, oracle::render(scene, view), renderer.render(view).image).passes()) << seed;
    }
  }
};

TEST_F(SoftLightTest, EachSampleIsTheOracles) {
  expect_samples(make_soft_scene(), make_soft_view());
}

TEST_F(SoftLightTest, EachSampleOfFlatLightsIsTheOracles) {
  expect_samples(make_flat_scene(), make_soft_view());
}

/// The same scene with metals and a coat, smooth and rough.
world::Scene make_glossy_scene() {
  world::Scene scene = make_soft_scene();
  MetallicRoughness metal;
  metal.base_color = vec3(0.9F, 0.7F, 0.4F);
  metal.metallic = 1.0F;
  metal.roughness = 0.25F;
  MetallicRoughness coated;
  coated.base_color = vec3(0.2F, 0.3F, 0.7F);
  coated.metallic = 0.0F;
  coated.roughness = 0.8F;
  coated.clearcoat = 1.0F;
  coated.clearcoat_roughness = 0.15F;
  MetallicRoughness floor;
  floor.metallic = 0.0F;
  floor.roughness = 0.35F;
  scene.materials = {{.name = "", .model = floor}, {.name = "", .model = metal}, {.name = "", .model = coated}};
  return scene;
}

// Half of the samples of smooth lobes choose a direction that the lobe reflects.
TEST_F(SoftLightTest, EachSampleOfSmoothLobesIsTheOracles) {
  expect_samples(make_glossy_scene(), make_soft_view());
}

// The mean does not depend on how points are chosen: a lobe slightly wider than the light chooses points of the light
// alone. The reflectance of a narrow lobe that sees the lamp's image is its share of the lamp's radiance.
TEST_F(SoftLightTest, MirrorsOfLampsHaveTheLampsRadiance) {
  world::Scene scene;
  MetallicRoughness metal;
  metal.metallic = 1.0F;
  metal.roughness = 0.05F;
  scene.materials = {{.name = "", .model = metal}};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}};
  scene.lights = {make_ball(vec3(0.0F, 2.0F, 0.0F), 0.5F, 3.0F)};
  View view = make_soft_view(uvec2(8));
  view.camera.eye = vec3(0.0F, 3.0F, 0.0F);
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.camera.yfov = 0.01F;
  view.max_depth = 0;
  view.samples_per_pixel = 256;
  // Light of radiance L from the whole lobe is reflected as L by a white metal.
  EXPECT_NEAR(mean_of(scene, view).x / (3.0 / (std::numbers::pi * 0.25)), 1.0, 0.01);
}

// Each sample of a pixel has another number. The mean of several samples is right only if all are.
TEST_F(SoftLightTest, NumberedSamplesAreTheOracles) {
  const world::Scene scene = make_soft_scene();
  View view = make_soft_view();
  const auto mean_of_oracle = [&](const auto& choice_of) {
    oracle::Picture mean;
    for (uint32_t number = 0; number < 4; ++number) {
      const oracle::Picture one =
          oracle::render(scene, view, [&](const uvec2& pixel) { return choice_of(pixel, number); });
      if (number == 0) mean = one;
      for (size_t i = 0; i < one.pixels.size(); ++i) {
        if (number > 0) mean.pixels[i].color += one.pixels[i].color;
        mean.pixels[i].explained_error += one.pixels[i].explained_error;
      }
    }
    for (oracle::Pixel& pixel : mean.pixels) pixel.color *= 0.25L;
    return mean;
  };
  view.samples_per_pixel = 4;
  const oracle::Picture lattice = mean_of_oracle([&](const uvec2& /*pixel*/, uint32_t number) {
    const vec2 place = sample_point(view, lattice_generator(4), number);
    return oracle::SampleChoice{{place.x, place.y}, number};
  });
  EXPECT_TRUE(compare(scene, lattice, renderer_of(scene).render(view).image).passes());

  view.samples_per_pixel = 1;
  view.seed = 7;
  view.error_target = ErrorTarget{.error = 1.0F, .min_samples = 4, .max_samples = 4};
  const FilterPlaces filter(view);
  const oracle::Picture net = mean_of_oracle([&](const uvec2& pixel, uint32_t number) {
    const vec2 place = filter.at(ScrambledPoints(pixel, view.seed).at(number));
    return oracle::SampleChoice{{place.x, place.y}, number, true};
  });
  EXPECT_TRUE(compare(scene, net, renderer_of(scene).render(view).image).passes());
}

TEST_F(SoftLightTest, SamplesThroughALensAreTheOracles) {
  View view = make_soft_view();
  view.camera.aperture_radius = 0.15F;
  view.camera.focus_distance = 4.0F;
  expect_samples(make_soft_scene(), view);
}

// A density that is off by 2 % is seen, and so are other faults.
TEST_F(SoftLightTest, FaultsInPointsAreSeen) {
  for (const char* fault : test::cases_of<const char*>({"light_density_off", "light_order_unshuffled", "flat_angle_off",
                                                        "flat_cosine_left_out", "lobe_density_off", "lens_turned"},
                                                       1)) {
    const std::string name = fault;
    const world::Scene scene = name.starts_with("flat")   ? make_flat_scene()
                               : name.starts_with("lobe") ? make_glossy_scene()
                                                          : make_soft_scene();
    View view = make_soft_view();
    if (name.starts_with("lens")) {
      view.camera.aperture_radius = 0.15F;
      view.camera.focus_distance = 4.0F;
    }
    const test::FaultyShaders faulty(fault);
    TunedRendererOptions options;
    options.shaders = faulty.shaders();
    const Image image = renderer_of(scene, options).render(view).image;
    EXPECT_FALSE(compare(scene, oracle::render(scene, view), image).passes()) << fault;
  }
}

// A picture of many samples is the mean over the light. A ball or a disc wholly above the horizon lights a point like a
// light without size (E = I cos / d^2), which is the closed form.
TEST_F(SoftLightTest, WholeLightsHaveTheirPower) {
  world::Scene scene;
  scene.materials = {make_matte(vec3(1.0F))};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}};
  View view = make_soft_view(uvec2(16));
  view.camera.eye = vec3(0.3F, 3.0F, 0.2F);
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.samples_per_pixel = 256;
  Light spot = make_ball(vec3(0.0F, 2.0F, 0.0F), 0.2F, 5.0F);
  spot.kind = LightKind::kSpot;
  spot.direction = vec3(0, -1, 0);
  spot.inner_cone_angle = 1.3F;
  spot.outer_cone_angle = 1.5F;
  Light sun = test::make_sun(vec3(0.3F, -1.0F, 0.1F), 0.7F);
  sun.angle = 0.6F;
  Light classic = make_ball(vec3(0.5F, 2.0F, 0.0F), 1.2F, 0.6F);
  classic.attenuation = Attenuation::kNone;
  for (const Light& light : {make_ball(vec3(0.2F, 1.5F, -0.3F), 1.0F, 2.0F), spot, sun, classic}) {
    scene.lights = {light};
    const double soft = mean_of(scene, view).x;
    scene.lights[0].radius = 0.0F;
    scene.lights[0].angle = 0.0F;
    const double hard = mean_of(scene, view).x;
    EXPECT_NEAR(soft / hard, 1.0, 0.001) << static_cast<int>(light.kind);
  }
}

// A ball whose centre lies on the floor is cut by the horizon: E = L (s - sin s cos s) for the angular radius s. A
// point inside a ball has the irradiance pi L.
TEST_F(SoftLightTest, CutBallsHaveTheirClosedForm) {
  world::Scene scene;
  scene.materials = {make_matte(vec3(1.0F))};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}};
  scene.lights = {make_ball(vec3(0.0F), 0.5F, 3.0F)};
  View view = make_soft_view(uvec2(8));
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.camera.yfov = 0.02F;
  view.samples_per_pixel = 256;
  const double radiance = 3.0 / (std::numbers::pi * 0.25);
  for (const double distance : {0.55, 0.8, 2.0}) {
    view.camera.eye = vec3(static_cast<float>(distance), 1.0F, 0.0F);
    const double s = std::asin(0.5 / distance);
    const double expected = radiance * (s - std::sin(s) * std::cos(s));
    // A pixel of the white Phong floor has the radiance E.
    EXPECT_NEAR(mean_of(scene, view).x / expected, 1.0, 0.01) << distance;
  }
  view.camera.eye = vec3(0.1F, 1.0F, 0.0F);
  EXPECT_NEAR(mean_of(scene, view).x / (std::numbers::pi * radiance), 1.0, 0.01) << "inside";
}

// E = L / 2 sum of angle_i cos_i over the edges (Lambert's formula for polygons), and E = pi L r^2 / (r^2 + h^2) on the
// axis of a disk. Behind a flat light there is no light.
TEST_F(SoftLightTest, FlatLightsHaveTheirClosedForm) {
  world::Scene scene;
  scene.materials = {make_matte(vec3(1.0F))};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}};
  View view = make_soft_view(uvec2(8));
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.camera.yfov = 0.002F;
  view.samples_per_pixel = 256;
  Light light = make_ball(vec3(0.1F, 0.6F, -0.2F), 0.0F, 2.0F);
  light.kind = LightKind::kRect;
  light.direction = vec3(0, -1, 0);
  for (const vec2& size : {vec2(1.3F, 0.6F), vec2(0.1F, 0.05F)}) {
    for (const dvec3& at : {dvec3(0, 0, 0), dvec3(0.9, 0, 0.4), dvec3(-2.0, 0, 1.5)}) {
      light.size = size;
      scene.lights = {light};
      view.camera.eye = vec3(at + dvec3(0, 0.3, 0));
      const dvec3 x = 0.5 * static_cast<double>(size.x) * dvec3(1, 0, 0);
      const dvec3 z = 0.5 * static_cast<double>(size.y) * dvec3(0, 0, 1);
      const dvec3 middle = dvec3(light.position) - at;
      const std::array<dvec3, 4> corners = {middle - x - z, middle + x - z, middle + x + z, middle - x + z};
      double sum = 0.0;
      for (size_t i = 0; i < 4; ++i) {
        const dvec3 a = glm::normalize(corners[i]);
        const dvec3 b = glm::normalize(corners[(i + 1) % 4]);
        sum += std::acos(glm::dot(a, b)) * glm::normalize(glm::cross(b, a)).y;
      }
      EXPECT_NEAR(mean_of(scene, view).x / std::abs(0.5 * 2.0 * sum), 1.0, 0.003) << size.x << " " << at.x;
    }
  }
  light.kind = LightKind::kDisk;
  view.camera.eye = vec3(0.1F, 0.3F, -0.2F);
  for (const double radius : {0.5, 0.05}) {
    light.size = vec2(static_cast<float>(2.0 * radius));
    scene.lights = {light};
    const double expected = std::numbers::pi * 2.0 * radius * radius / (radius * radius + 0.36);
    EXPECT_NEAR(mean_of(scene, view).x / expected, 1.0, 0.003) << radius;
  }
  scene.lights[0].direction = vec3(0, 1, 0);
  EXPECT_EQ(mean_of(scene, view).x, 0.0);
}

// Half of a sun's disc is visible below a straight edge that points at its middle.
TEST_F(SoftLightTest, EdgesShowTheirShareOfTheSun) {
  world::Scene scene;
  scene.materials = {make_matte(vec3(1.0F))};
  Mesh roof = test::make_board();
  for (vec3& p : roof.positions) p = vec3(p.x < 0.0F ? -40.0F : 0.0F, 1.0F, 40.0F * p.y);
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}, {"roof", roof, 0}};
  scene.lights = {test::make_sun(vec3(0, -1, 0))};
  const double half_angle = 0.05;
  scene.lights[0].angle = static_cast<float>(2.0 * half_angle);
  View view = make_soft_view(uvec2(8));
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.camera.projection = Projection::kOrthographic;
  view.camera.ymag = 1e-4F;
  view.samples_per_pixel = 64;
  for (const double offset : {-0.7, -0.3, 0.0, 0.4, 0.9}) {
    // The eye is below the roof. `offset` is in radii of the disc.
    view.camera.eye = vec3(static_cast<float>(offset * std::tan(half_angle)), 0.5F, 0.0F);
    const double covered = (std::acos(offset) - offset * std::sqrt(1.0 - offset * offset)) / std::numbers::pi;
    EXPECT_NEAR(mean_of(scene, view).x, 1.0 - covered, 0.006) << offset;
  }
}

// A light without size has the same bits in kernels for lights with one.
TEST_F(SoftLightTest, LightsWithoutSizeKeepTheirBits) {
  world::Scene scene = make_soft_scene();
  for (Light& light : scene.lights) light.radius = light.angle = 0.0F;
  View view = make_soft_view();
  view.samples_per_pixel = 3;
  const Image hard = renderer_of(scene).render(view).image;
  TunedRendererOptions options;
  options.more_features = layout::FEATURE_SAMPLED_LIGHT | layout::FEATURE_LENS;
  EXPECT_TRUE(test::has_same_bits(renderer_of(scene, options).render(view).image, hard));
  // A radius that fp32 cannot square counts as none.
  for (Light& light : scene.lights) light.radius = 1e-20F;
  EXPECT_TRUE(test::has_same_bits(renderer_of(scene).render(view).image, hard));
}

TEST_F(SoftLightTest, EveryWayOfTracingHasTheSameBits) {
  const world::Scene scene = make_soft_scene();
  View view = make_soft_view();
  view.samples_per_pixel = 3;
  view.camera.aperture_radius = 0.1F;
  view.camera.focus_distance = 3.0F;
  const Image expected = expect_same_bits(scene, view);
  view.seed = 1;
  EXPECT_FALSE(test::has_same_bits(renderer_of(scene).render(view).image, expected));
}

// Lamps that touch or surround what they light, of all sizes, have finite light.
TEST_F(SoftLightTest, ExtremeSizesGiveFinitePictures) {
  world::Scene scene = make_soft_scene();
  View view = make_soft_view(uvec2(16, 12));
  Renderer renderer = renderer_of(scene);
  for (const float radius : {1e-18F, 1e-6F, 2.0F, 1e6F, 1e15F}) {
    for (const vec3& position : {vec3(0.0F), vec3(-0.8F, 0.5F, 0.0F), vec3(1e7F, 1e7F, 0.0F)}) {
      scene.lights = {make_ball(position, radius, 1.0F)};
      renderer.set_lights(scene.lights);
      for (const vec3& pixel : renderer.render(view).image.pixels) {
        ASSERT_TRUE(std::isfinite(pixel.x) && pixel.x >= 0.0F) << radius << " " << position.x;
      }
    }
  }
  scene.lights = {test::make_sun(vec3(0, -1, 0))};
  for (const float angle : {1e-30F, 1e-6F, 3.1415927F}) {
    scene.lights[0].angle = angle;
    renderer.set_lights(scene.lights);
    for (const vec3& pixel : renderer.render(view).image.pixels) ASSERT_TRUE(std::isfinite(pixel.x)) << angle;
  }
  scene.lights = {make_flat_scene().lights[0], make_flat_scene().lights[1]};
  for (const vec2& size : {vec2(1e-15F), vec2(1e6F, 1e-6F), vec2(1e15F)}) {
    for (const vec3& position : {vec3(0.0F), vec3(-0.8F, 0.5F, 0.0F), vec3(0.0F, 2.0F, 0.0F)}) {
      for (Light& light : scene.lights) {
        light.size = light.kind == LightKind::kDisk ? vec2(size.x) : size;
        light.position = position;
      }
      renderer.set_lights(scene.lights);
      for (const vec3& pixel : renderer.render(view).image.pixels) {
        ASSERT_TRUE(std::isfinite(pixel.x) && pixel.x >= 0.0F) << size.x << " " << size.y << " " << position.y;
      }
    }
  }
}

}  // namespace
}  // namespace promin
