// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "environment/pack_sky.h"
#include "environment/sky_radiance.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/lighting.h"
#include "promin/renderer.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

using test::has_same_bits;

constexpr float kRoughnesses[] = {0.0F, 0.05F, 0.1F, 0.15F, 0.2F, 0.3F, 0.35F, 0.5F, 0.6F, 0.8F, 1.0F};

Material make_rough_metal(float roughness) {
  Material material;
  material.model = MetallicRoughness{.roughness = roughness};
  return material;
}

Material make_mirror() {
  Material material;
  material.phong().ambient = material.phong().diffuse = vec3(0.0F);
  material.phong().reflection = vec3(1.0F);
  return material;
}

/// Returns a row of balls, one for each material.
world::Scene make_balls(const std::vector<Material>& materials) {
  world::Scene scene;
  scene.materials = materials;
  for (uint32_t i = 0; i < materials.size(); ++i) {
    scene.objects.push_back({"", world::Sphere{vec3(2.5F * static_cast<float>(i), 0, 0), 1.0F}, i});
  }
  return scene;
}

View make_sky_view(const vec3& eye, const vec3& look, const vec3& up, uvec2 size) {
  View view;
  view.camera.eye = eye;
  view.camera.look = look;
  view.camera.up = up;
  view.size = size;
  return view;
}

/// Returns a view of the unit ball around the origin along an axis. The mirror ray of the middle pixel comes straight
/// back.
View look_from(const vec3& axis) {
  const vec3 up = axis.y == 0.0F ? vec3(0, 1, 0) : vec3(0, 0, 1);
  return make_sky_view(5.0F * axis, -axis, up, uvec2(1));
}

Panorama paint_panorama(uvec2 size, const std::function<vec3(uint32_t, uint32_t)>& pixel) {
  auto image = std::make_shared<Image>();
  image->size = size;
  for (uint32_t y = 0; y < size.y; ++y) {
    for (uint32_t x = 0; x < size.x; ++x) image->pixels.push_back(pixel(x, y));
  }
  return {image};
}

/// The directions of the patches and their colours.
struct Patch {
  vec3 axis;
  vec3 color;
};
constexpr Patch kPatches[] = {{{1, 0, 0}, {1, 0, 0}},  {{-1, 0, 0}, {0, 1, 1}}, {{0, 1, 0}, {0, 1, 0}},
                              {{0, -1, 0}, {1, 0, 1}}, {{0, 0, 1}, {0, 0, 1}},  {{0, 0, -1}, {1, 1, 0}}};

/// Returns a panorama. Its first and last rows are top and bottom. The columns between them are behind, left, ahead and
/// right.
Panorama make_patches() {
  return paint_panorama({64, 32}, [](uint32_t x, uint32_t y) {
    if (y < 8) return kPatches[2].color;
    if (y >= 24) return kPatches[3].color;
    const uint32_t quarter = (x + 8) / 16 % 4;
    return kPatches[quarter == 0 ? 4 : quarter == 1 ? 1 : quarter == 2 ? 5 : 0].color;
  });
}

class SkyPictureTest : public test::DeviceTest {
 protected:
  /// Uses kernels that have the features of all scenes here.
  static Image render(const world::Scene& scene, const View& view) {
    using namespace layout;
    TunedRendererOptions options;
    options.more_features = FEATURE_SPHERES | FEATURE_DIRECTIONAL_LIGHTS | FEATURE_PHONG | FEATURE_METALLIC_ROUGHNESS |
                            FEATURE_SHADOWS | FEATURE_SPECULAR | FEATURE_MIRRORS | FEATURE_SKY | FEATURE_SHOWN_SKY;
    return render_with(scene, view, options);
  }
  static Image render_with(const world::Scene& scene, const View& view, const TunedRendererOptions& options) {
    return make_renderer(device(), scene, options).render(view).image;
  }
};

// A white metal in a white sky is invisible.
TEST_F(SkyPictureTest, AWhiteFurnaceIsWhite) {
  std::vector<Material> metals;
  for (const float roughness : kRoughnesses) metals.push_back(make_rough_metal(roughness));
  world::Scene scene = make_balls(metals);
  scene.environment.sky = paint_panorama({4, 2}, [](uint32_t, uint32_t) { return vec3(1.0F); });
  scene.environment.background = vec3(1.0F);
  View view = make_sky_view(vec3(12.5F, 0, 20), vec3(0, 0, -1), vec3(0, 1, 0), uvec2(280, 20));
  view.camera.yfov = 0.11F;
  const Image image = render(scene, view);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(image.pixels[i][c], 1.0F, 1e-5F) << i;
  }
}

world::Scene make_studio_scene() {
  std::vector<Material> materials;
  for (const float roughness : kRoughnesses) materials.push_back(make_rough_metal(roughness));
  std::get<MetallicRoughness>(materials[3].model).metallic = 0.0F;
  materials.push_back(make_mirror());
  materials.push_back({});
  world::Scene scene = make_balls(materials);
  scene.environment.sky = Studio{0.3F};
  scene.environment.ambient = vec3(0.125F);
  scene.environment.background = vec3(0.25F);
  scene.lights = {make_studio_light(0.3F)};
  return scene;
}

View make_studio_view() {
  View view = make_sky_view(vec3(12.5F, 2, 24), glm::normalize(vec3(0, -2, -24)), glm::normalize(vec3(0, 24, -2)),
                            uvec2(320, 48));
  view.camera.yfov = 0.2F;
  return view;
}

TEST_F(SkyPictureTest, StorageTexelsAndSpecialisationChangeNoBit) {
  const world::Scene scene = make_studio_scene();
  const Image image = render_with(scene, make_studio_view(), {});
  EXPECT_TRUE(has_same_bits(render(scene, make_studio_view()), image));
  TunedRendererOptions storage;
  storage.avoids_texels = true;
  EXPECT_TRUE(has_same_bits(render_with(scene, make_studio_view(), storage), image));
  TunedRendererOptions forced;
  forced.more_features = all_features();
  EXPECT_TRUE(has_same_bits(render_with(scene, make_studio_view(), forced), image));
  world::Scene bare = scene;
  bare.environment.sky = std::monostate();
  const Image bare_image = render_with(bare, make_studio_view(), {});
  EXPECT_FALSE(has_same_bits(bare_image, image));
  EXPECT_TRUE(has_same_bits(render_with(bare, make_studio_view(), forced), bare_image));
}

TEST_F(SkyPictureTest, CamerasSeeTheSkyWhereItIsShown) {
  world::Scene scene;
  scene.environment.sky = make_patches();
  scene.environment.background = vec3(0.25F);
  TunedRendererOptions forced;
  forced.more_features = all_features();
  for (const Patch& patch : kPatches) {
    scene.environment.shows_sky = true;
    View view = look_from(-patch.axis);
    EXPECT_LT(glm::distance(render(scene, view).pixels[0], patch.color), 1e-3F);
    scene.environment.shows_sky = false;
    EXPECT_EQ(render(scene, view).pixels[0], scene.environment.background);
    if (patch.axis.x <= 0.0F) continue;
    // Only this case uses all features, because they take long to compile.
    EXPECT_EQ(render_with(scene, view, forced).pixels[0], scene.environment.background);
  }
}

TEST_F(SkyPictureTest, ASkyIsReplacedWithoutATree) {
  const world::Scene scene = make_studio_scene();
  world::Scene bare = scene;
  bare.environment.sky = std::monostate();
  Renderer renderer = make_renderer(device(), bare);
  const Image before = renderer.render(make_studio_view()).image;
  renderer.set_environment(scene.environment);
  EXPECT_TRUE(has_same_bits(renderer.render(make_studio_view()).image, render(scene, make_studio_view())));
  renderer.set_environment(bare.environment);
  EXPECT_TRUE(has_same_bits(renderer.render(make_studio_view()).image, before));
}

TEST_F(SkyPictureTest, MirrorsSeeEachPatchWhereItIs) {
  for (const Material& material : {make_rough_metal(0.0F), make_mirror()}) {
    world::Scene scene = make_balls({material});
    scene.environment.sky = make_patches();
    for (const Patch& patch : kPatches) {
      EXPECT_LT(glm::distance(render(scene, look_from(patch.axis)).pixels[0], patch.color), 1e-3F);
    }
  }
}

TEST_F(SkyPictureTest, RotationAndIntensityAreSeen) {
  world::Scene scene = make_balls({make_rough_metal(0.0F)});
  scene.environment.sky = make_patches();
  scene.environment.rotation = 0.5F * std::numbers::pi_v<float>;
  scene.environment.intensity = 4.0F;
  // The rotation moves the light from +Z to +X.
  EXPECT_LT(glm::distance(render(scene, look_from(vec3(1, 0, 0))).pixels[0], 4.0F * kPatches[4].color), 4e-3F);
  EXPECT_LT(glm::distance(render(scene, look_from(vec3(0, 0, -1))).pixels[0], 4.0F * kPatches[0].color), 4e-3F);
}

TEST_F(SkyPictureTest, AmbientLightIsTheIrradiance) {
  Material matt;
  matt.phong().ambient = vec3(1.0F);
  world::Scene scene = make_balls({matt});
  scene.environment.sky = GradientSky{};
  const PackedSky sky = pack_sky(scene.environment);
  for (const Patch& patch : kPatches) {
    const vec3 n = patch.axis;
    const float basis[9] = {
        1.0F, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3.0F * n.z * n.z - 1.0F, n.z * n.x, n.x * n.x - n.y * n.y};
    vec3 wanted(0.0F);
    for (int i = 0; i < 9; ++i) wanted += basis[i] * vec3(sky.irradiance[i]);
    EXPECT_LT(glm::distance(render(scene, look_from(n)).pixels[0], wanted), 1e-5F);
  }
}

// A rough metal shows the mean over its lobe also for a roughness between two levels.
TEST_F(SkyPictureTest, RoughMetalsShowTheLevelBetween) {
  for (const float roughness : {0.45F, 0.6F, 0.8F, 1.0F}) {
    world::Scene scene = make_balls({make_rough_metal(roughness)});
    scene.environment.sky = Studio{};
    const Image at_once = render(scene, look_from(vec3(0, 0, 1)));
    // The test interpolates between the two neighbouring levels.
    const float lower = roughness < 0.6F ? 0.35F : 0.6F;
    const float upper = roughness < 0.6F ? 0.6F : 1.0F;
    const auto seen_at = [&](float r) {
      world::Scene level = scene;
      level.materials = {make_rough_metal(r)};
      View view = look_from(vec3(0, 0, 1));
      // There is no mirror ray, so that all light comes from the level.
      view.max_depth = 0;
      return render(level, view).pixels[0].x;
    };
    const float share = (roughness - lower) / (upper - lower);
    const float wanted = seen_at(lower) + share * (seen_at(upper) - seen_at(lower));
    EXPECT_NEAR(at_once.pixels[0].x, wanted, 2e-3F) << roughness;
  }
}

}  // namespace
}  // namespace promin
