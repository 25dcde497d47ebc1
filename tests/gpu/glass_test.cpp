// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check glass (docs/model.md, "Glass") in scenes whose light has a closed form. They also check that no bit
// depends on how the picture is traced.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "gpu/ways_of_tracing.h"
#include "promin/explain.h"
#include "promin/validate.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

constexpr float kU = 0x1p-24F;

Material make_clear(const MetallicRoughness& model) {
  Material material;
  material.model = model;
  return material;
}

/// Returns glass that transmits all light that it does not reflect.
MetallicRoughness clear_model() {
  MetallicRoughness model;
  model.metallic = 0.0F;
  model.roughness = 0.0F;
  model.transmission = 1.0F;
  return model;
}

Material make_classic(float transmission, float ior, float reflection = 0.0F) {
  Phong phong{.ambient = vec3(0.0F), .diffuse = vec3(0.0F)};
  phong.transmission = vec3(transmission);
  phong.ior = ior;
  phong.reflection = vec3(reflection);
  Material material;
  material.model = phong;
  return material;
}

/// Returns an orthographic view of one pixel in this direction. The eye is above the origin at y = 4.
View look_down(const vec3& look = vec3(0, -1, 0)) {
  View view;
  view.size = uvec2(1);
  view.max_depth = kMaxDepthOfGlass;
  view.camera.projection = Projection::kOrthographic;
  view.camera.look = look;
  view.camera.eye = -4.0F * look;
  view.camera.up = vec3(0, 0, 1);
  view.camera.ymag = 1e-4F;
  return view;
}

class GlassTest : public DeviceTest {
 protected:
  static RenderResult trace(const world::Scene& scene, const View& view) {
    return make_renderer(device(), scene).render(view);
  }
  static vec3 see(const world::Scene& scene, const View& view) { return trace(scene, view).image.pixels.front(); }
};

world::Scene make_scene(const world::Shape& shape, const Material& material) {
  world::Scene scene;
  scene.environment.background = vec3(1.0F);
  scene.materials = {material};
  scene.objects = {{"glass", shape, 0}};
  return scene;
}

const world::Box kSlab{vec3(0.0F), vec3(3.0F, 0.5F, 3.0F), vec3(0.0F)};

TEST_F(GlassTest, ClassicWeightsCountAtEachFace) {
  const world::Scene scene = make_scene(kSlab, make_classic(0.5F, 1.5F));
  const RenderResult result = trace(scene, look_down());
  EXPECT_EQ(result.image.pixels.front(), vec3(0.25F));
  EXPECT_EQ(result.rays.primary_hits, 1U);
  EXPECT_EQ(result.rays.refraction, 2U);
  EXPECT_EQ(result.rays.reflection, 0U);
}

TEST_F(GlassTest, WithoutBouncesNoRayIsTraced) {
  View view = look_down();
  view.max_depth = 0;
  const RenderResult result = trace(make_scene(kSlab, make_classic(0.5F, 1.5F, 0.5F)), view);
  EXPECT_EQ(result.image.pixels.front(), vec3(0.0F));
  EXPECT_EQ(result.rays.total(), 1U);
}

// The environment replaces a ray that is not traced, so a colourless ball has the same brightness as the environment.
TEST_F(GlassTest, BeyondTheDepthTheEnvironmentIsSeen) {
  MetallicRoughness model = clear_model();
  model.thickness = 1.0F;
  world::Scene scene = make_scene(world::Sphere{vec3(0.0F), 1.0F}, make_clear(model));
  scene.environment.ambient = vec3(1.0F);
  for (const uint32_t depth : {0U, 1U, 2U, 5U}) {
    View view = look_down();
    view.max_depth = depth;
    view.camera.eye.x = 0.6F;
    EXPECT_NEAR(see(scene, view).g, 1.0F, 8 * kU) << depth;
  }
}

TEST_F(GlassTest, AMediumAbsorbsByTheWayThroughIt) {
  MetallicRoughness model = clear_model();
  model.thickness = 1.0F;
  model.specular = 0.0F;
  model.base_color = vec3(0.81F, 0.25F, 1.0F);
  model.attenuation_color = vec3(0.5F, 0.25F, 1.0F);
  model.attenuation_distance = 2.0F;
  world::Scene scene = make_scene(kSlab, make_clear(model));
  scene.environment.ambient = vec3(1.0F);
  // Each face has half of the base colour. The length of the ray inside the glass is 1.
  const vec3 seen = see(scene, look_down());
  EXPECT_NEAR(seen.r, 0.81F * std::sqrt(0.5F), 32 * kU);
  EXPECT_NEAR(seen.g, 0.25F * 0.5F, 32 * kU);
  EXPECT_NEAR(seen.b, 1.0F, 32 * kU);
}

TEST_F(GlassTest, AThinWallBendsNothingAndTintsOnce) {
  MetallicRoughness model = clear_model();
  model.specular = 0.0F;
  model.base_color = vec3(0.5F, 0.25F, 1.0F);
  const world::Scene scene = make_scene(world::Plane{vec3(0.0F), vec3(0, 1, 0)}, make_clear(model));
  // A ray that is neither bent nor blurred sees the background.
  const vec3 seen = see(scene, look_down(glm::normalize(vec3(0.6F, -0.8F, 0.0F))));
  EXPECT_NEAR(seen.r, 0.5F, 8 * kU);
  EXPECT_NEAR(seen.g, 0.25F, 8 * kU);
  EXPECT_NEAR(seen.b, 1.0F, 8 * kU);
}

TEST_F(GlassTest, FresnelsShareIsThatOfTheFormula) {
  Material material = make_classic(1.0F, 1.5F, 1.0F);
  material.phong().fresnel = true;
  world::Scene scene = make_scene(kSlab, material);
  scene.materials.push_back(Material());
  scene.materials[1].model = Unlit{vec3(0.0F)};
  // No light comes from below.
  scene.objects.push_back({"floor", world::Plane{vec3(0, -2, 0), vec3(0, 1, 0)}, 1});
  for (const double cosine : {1.0, 0.7, 0.3, 0.2}) {
    View view =
        look_down(vec3(static_cast<float>(std::sqrt(1.0 - cosine * cosine)), static_cast<float>(-cosine), 0.0F));
    view.max_depth = 1;
    const double beyond = std::sqrt(1.0 - (1.0 - cosine * cosine) / 2.25);
    const double s = (cosine - 1.5 * beyond) / (cosine + 1.5 * beyond);
    const double p = (beyond - 1.5 * cosine) / (beyond + 1.5 * cosine);
    EXPECT_NEAR(see(scene, view).r, 0.5 * (s * s + p * p), 1e-6) << cosine;
  }
}

// In KHR_materials_dispersion, n of blue and red differ by 0.025 (n - 1) dispersion from n.
TEST_F(GlassTest, EachColorIsBentByItsOwnIndex) {
  MetallicRoughness model = clear_model();
  model.thickness = 1.0F;
  model.specular = 0.0F;
  model.ior = 1.5F;
  model.dispersion = 8.0F;
  const View view = look_down(glm::normalize(vec3(0.6F, -0.8F, 0.0F)));
  Renderer renderer = make_renderer(device(), make_scene(kSlab, make_clear(model)));
  const ExplainedSample sample = renderer.explain(view, uvec2(0)).samples.front();
  ASSERT_EQ(sample.rays.size(), 7U) << "the camera's, and of each color one within and one beyond";
  for (int color = 0; color < 3; ++color) {
    const double index = 1.5 + 0.1 * (color - 1);
    const ExplainedRay& within = sample.rays[1 + 2 * static_cast<size_t>(color)];
    const ExplainedRay& beyond = sample.rays[2 + 2 * static_cast<size_t>(color)];
    for (const ExplainedRay* ray : {&within, &beyond}) {
      EXPECT_EQ(ray->kind, RayKind::kRefraction);
      for (int other = 0; other < 3; ++other) EXPECT_EQ(ray->weight[other] > 0.0F, other == color);
    }
    EXPECT_EQ(within.parent, 0U);
    const double sine = glm::normalize(dvec3(within.ray.direction)).x;
    EXPECT_NEAR(sine, 0.6 / index, 8 * kU) << color;
    EXPECT_NEAR(glm::normalize(dvec3(beyond.ray.direction)).x, 0.6, 16 * kU) << "a slab shifts, and turns nothing";
  }
}

// From within, each color is reflected totally beyond its own critical angle.
TEST_F(GlassTest, EachColorIsReflectedTotallyAtItsOwnAngle) {
  MetallicRoughness model = clear_model();
  model.thickness = 1.0F;
  model.ior = 1.5F;
  model.dispersion = 8.0F;
  // The sine is between 1 / 1.6 and 1 / 1.5, so that blue is reflected totally.
  const float sine = 0.65F;
  View view = look_down(vec3(sine, -std::sqrt(1.0F - sine * sine), 0.0F));
  view.camera.projection = Projection::kPerspective;
  view.camera.yfov = 1e-5F;
  view.camera.eye = vec3(0.0F);
  view.max_depth = 1;
  Renderer renderer = make_renderer(device(), make_scene(kSlab, make_clear(model)));
  const ExplainedSample sample = renderer.explain(view, uvec2(0)).samples.front();
  ASSERT_EQ(sample.rays.size(), 5U) << "the camera's, its mirror ray, and one of each color";
  EXPECT_LT(sample.rays[2].ray.direction.y, 0.0F);
  EXPECT_LT(sample.rays[3].ray.direction.y, 0.0F);
  EXPECT_GT(sample.rays[4].ray.direction.y, 0.0F);
  EXPECT_NEAR(glm::normalize(dvec3(sample.rays[4].ray.direction)).x, 0.65, 16 * kU);
}

TEST_F(GlassTest, ShadowsAreTinted) {
  Material material = make_classic(0.5F, 1.5F);
  material.phong().transmission = vec3(0.5F, 0.25F, 1.0F);
  world::Scene scene = make_scene(kSlab, material);
  Material matt;
  matt.model = Phong{.ambient = vec3(0.0F), .diffuse = vec3(1.0F)};
  scene.materials.push_back(matt);
  scene.objects.push_back({"floor", world::Plane{vec3(0, -2, 0), vec3(0, 1, 0)}, 1});
  Light sun;
  sun.kind = LightKind::kDirectional;
  sun.direction = vec3(0, -1, 0);
  scene.lights = {sun};
  View view = look_down();
  // The eye is below the slab.
  view.camera.eye.y = -1.0F;
  const RenderResult result = trace(scene, view);
  EXPECT_EQ(result.image.pixels.front(), vec3(0.25F, 0.0625F, 1.0F));
  EXPECT_EQ(result.rays.passed, 2U);
}

TEST_F(GlassTest, EveryWayOfTracingGivesTheSameBits) {
  const world::Scene scene = make_scene_of_glass();
  View view = make_view({96, 72});
  view.samples_per_pixel = 3;
  view.max_depth = kMaxDepthOfGlass;
  const RenderResult expected = make_renderer(device(), scene).render(view);
  EXPECT_GT(expected.rays.refraction, 5000U);
  for (const TunedRendererOptions& options : ways_of_tracing()) {
    const RenderResult result = make_renderer(device(), scene, options).render(view);
    EXPECT_TRUE(has_same_bits(result.image, expected.image));
    EXPECT_EQ(result.rays.refraction, expected.rays.refraction);
    EXPECT_EQ(result.rays.reflection, expected.rays.reflection);
  }
}

// There are more light sources than the stream handles in one turn, so some rays are traced again while others wait.
TEST_F(GlassTest, ManySourcesLightWhatIsBehindGlass) {
  world::Scene scene = make_scene_of_glass();
  View view = make_view({48, 36});
  view.max_depth = kMaxDepthOfGlass;
  const RenderResult expected = trace(scene, view);
  Light dark = scene.lights[0];
  dark.diffuse = dark.specular = vec3(0.0F);
  scene.lights.insert(scene.lights.begin(), layout::STREAM_SOURCES, dark);
  const RenderResult result = trace(scene, view);
  EXPECT_TRUE(has_same_bits(result.image, expected.image));
  EXPECT_EQ(result.rays.refraction, expected.rays.refraction);
}

}  // namespace
}  // namespace promin::test
