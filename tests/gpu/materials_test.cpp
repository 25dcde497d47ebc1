// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check the models of materials on a device, in cases whose light is known without another picture.
#include "promin/materials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/rounding.h"
#include "gpu/device_fixture.h"
#include "oracle/lobe.h"
#include "oracle/picture.h"
#include "promin/renderer.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

constexpr float kRoundoff = 0x1p-24F;

Material make_metal(const MetallicRoughness& model) {
  Material material;
  material.model = model;
  return material;
}

/// Returns a scene without lights and with the same light from all directions, also for rays that leave the scene.
world::Scene make_furnace(float radiance = 1.0F) {
  world::Scene scene;
  scene.environment.ambient = scene.environment.background = vec3(radiance);
  return scene;
}

/// Returns a view of one orthographic pixel that looks along `look` at the origin.
View look_along(const vec3& look) {
  View view;
  view.size = uvec2(1);
  view.camera.projection = Projection::kOrthographic;
  view.camera.look = look;
  view.camera.eye = -4.0F * look;
  view.camera.up = vec3(0, 0, 1);
  view.camera.ymag = 0.001F;
  return view;
}

/// Returns the direction in the plane of x and y with this cosine to +y.
vec3 direction_at(float cosine) {
  return {std::sqrt(1.0F - cosine * cosine), cosine, 0.0F};
}

Light make_sun_at(const vec3& to_light, float power = 1.0F) {
  Light light;
  light.kind = LightKind::kDirectional;
  light.direction = -to_light;
  light.diffuse = light.specular = vec3(power);
  return light;
}

/// Returns the largest difference of a channel from a number.
float largest_difference(const Image& image, float wanted) {
  float largest = 0.0F;
  for (const vec3& pixel : image.pixels) {
    const vec3 difference = glm::abs(pixel - vec3(wanted));
    largest = std::max({largest, difference.x, difference.y, difference.z});
  }
  return largest;
}

class MaterialsTest : public test::DeviceTest {
 protected:
  static Image render(const world::Scene& scene, const View& view) {
    return make_renderer(device(), scene).render(view).image;
  }

  /// Returns the colour of a floor of one material, seen at an angle of this cosine.
  static vec3 color_of_floor(const Material& material, float cosine, world::Scene scene) {
    scene.materials = {material};
    scene.objects = {{"floor", world::Plane{vec3(0), vec3(0, 1, 0)}, 0}};
    return render(scene, look_along(-direction_at(cosine))).pixels[0];
  }
};

/// Returns three rows of eleven spheres, far apart: metallic is 0, .5 and 1, roughness goes from 0 to 1.
world::Scene make_spheres(const vec3& base_color) {
  world::Scene scene = make_furnace();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 11; ++column) {
      MetallicRoughness model;
      model.base_color = base_color;
      model.metallic = 0.5F * static_cast<float>(row);
      model.roughness = 0.1F * static_cast<float>(column);
      scene.objects.push_back(
          {"", world::Sphere{vec3(column - 5, row - 1, 0), 0.45F}, static_cast<uint32_t>(scene.materials.size())});
      scene.materials.push_back(make_metal(model));
    }
  }
  return scene;
}

View look_at_spheres() {
  View view = look_along(vec3(0, 0, -1));
  view.size = uvec2(352, 96);
  view.camera.up = vec3(0, 1, 0);
  view.camera.ymag = 1.5F;
  return view;
}

// In a white furnace the numbers of the table cancel, so the result is 1 for any table.
TEST_F(MaterialsTest, WhiteSpheresVanishInAWhiteFurnace) {
  Renderer renderer = make_renderer(device(), make_spheres(vec3(1.0F)));
  View view = look_at_spheres();
  for (const uint32_t depth : {0U, 1U, 5U}) {
    view.max_depth = depth;
    EXPECT_LE(largest_difference(renderer.render(view).image, 1.0F), 8.0F * kRoundoff) << depth;
  }
}

TEST_F(MaterialsTest, ColoredSpheresSendNoMoreThanTheyGet) {
  const Image image = render(make_spheres(vec3(0.9F, 0.5F, 0.0F)), look_at_spheres());
  size_t darker = 0;
  for (const vec3& pixel : image.pixels) {
    ASSERT_LE(max_component(pixel), 1.0F + 8.0F * kRoundoff);
    ASSERT_GE(std::min({pixel.x, pixel.y, pixel.z}), 0.0F);
    darker += pixel.z < 0.5F ? 1 : 0;
  }
  EXPECT_GT(darker, image.pixels.size() / 4);
}

// The layers below a sheen receive the light that the sheen does not reflect.
TEST_F(MaterialsTest, WhiteSpheresUnderWhiteSheensVanishInAWhiteFurnace) {
  for (const float roughness : {0.0F, 0.1F, 0.3F, 1.0F}) {
    world::Scene scene = make_spheres(vec3(1.0F));
    for (Material& material : scene.materials) {
      auto& model = std::get<MetallicRoughness>(material.model);
      model.sheen_color = vec3(1.0F);
      model.sheen_roughness = roughness;
    }
    EXPECT_LE(largest_difference(render(scene, look_at_spheres()), 1.0F), 8.0F * kRoundoff) << roughness;
  }
}

// The light that leaves on the other side is subtracted from the light scattered on this side.
TEST_F(MaterialsTest, WhiteSpheresThatScatterThroughVanishInAWhiteFurnace) {
  world::Scene scene = make_spheres(vec3(1.0F));
  std::optional<Renderer> renderer;
  for (const float share : {0.3F, 1.0F}) {
    for (Material& material : scene.materials) {
      std::get<MetallicRoughness>(material.model).diffuse_transmission = share;
    }
    if (!renderer) renderer.emplace(make_renderer(device(), scene));
    renderer->set_materials(scene.materials);
    EXPECT_LE(largest_difference(renderer->render(look_at_spheres()).image, 1.0F), 8.0F * kRoundoff) << share;
  }
}

// KHR_materials_diffuse_transmission: of the light on the front of a matt wall, the fraction 1 - f is reflected in the
// base colour; of the light on its back, the fraction f comes through in the other colour. Both are multiplied by the
// cosine over pi.
TEST_F(MaterialsTest, LightFromBehindIsScatteredThrough) {
  const vec3 color(0.25F, 0.5F, 1.0F);
  MetallicRoughness model{.base_color = vec3(0.5F), .metallic = 0.0F, .roughness = 1.0F, .specular = 0.0F};
  model.diffuse_transmission = 0.75F;
  model.diffuse_transmission_color = color;
  world::Scene scene;
  Mesh wall;
  wall.positions = {{-2, 0, -2}, {0, 0, 3}, {2, 0, -2}};
  wall.triangles = {{0, 1, 2}};
  scene.objects = {{"", wall, 0}};
  // This box blocks light from the left, on either side of the wall.
  scene.objects.push_back({"", world::Box{.center = vec3(-9, 0, 0), .half_size = vec3(1, 8, 8)}, 0});
  scene.materials = {make_metal(model)};
  scene.lights = {make_sun_at(vec3(0, 1, 0))};
  Renderer renderer = make_renderer(device(), scene);
  const View view = look_along(-glm::normalize(vec3(0.2F, 1, 0)));
  const auto seen_under = [&](const vec3& to_light) {
    renderer.set_lights(std::vector{make_sun_at(glm::normalize(to_light), std::numbers::pi_v<float>)});
    return renderer.render(view).image.pixels[0];
  };
  const float cosine = glm::normalize(vec3(3, 4, 0)).y;
  EXPECT_LE(max_abs_component(seen_under(vec3(3, 4, 0)) - 0.25F * 0.5F * cosine * vec3(1)), 8.0F * kRoundoff);
  EXPECT_LE(max_abs_component(seen_under(vec3(3, -4, 0)) - 0.75F * cosine * color), 8.0F * kRoundoff);
  EXPECT_EQ(seen_under(vec3(-9, 0.5F, 0)), vec3(0));
  EXPECT_EQ(seen_under(vec3(-9, -0.5F, 0)), vec3(0));
  EXPECT_EQ(seen_under(vec3(1, 0, 0)), vec3(0));
  // A metal does not scatter light, and neither does a material whose fraction is 0; here it stands beside the other
  // wall.
  for (const bool is_metal : {true, false}) {
    MetallicRoughness other = model;
    if (is_metal) other.metallic = 1.0F;
    if (!is_metal) other.diffuse_transmission = 0.0F;
    scene.objects[1].material = 1;
    scene.materials = {make_metal(other), make_metal(model)};
    scene.lights = {make_sun_at(vec3(0, -1, 0))};
    EXPECT_EQ(render(scene, view).pixels[0], vec3(0));
  }
}

// The body receives the light that the film does not reflect. In the colour that the film reflects most, the surface
// sends back all light.
TEST_F(MaterialsTest, AWhiteFloorUnderAFilmSendsAllOfOneColorInAWhiteFurnace) {
  for (const float thickness : {0.0F, 130.0F, 420.0F, 5000.0F}) {
    for (const float cosine : {1.0F, 0.4F, 0.01F}) {
      MetallicRoughness model{.metallic = 0.0F, .roughness = 0.3F};
      model.iridescence = 1.0F;
      model.iridescence_thickness_maximum = thickness;
      const vec3 seen = color_of_floor(make_metal(model), cosine, make_furnace());
      EXPECT_NEAR(max_component(seen), 1.0F, 8.0F * kRoundoff) << thickness << " nm at " << cosine;
    }
  }
}

// In a thick film waves no longer interfere: the light that is reflected to and fro in the film adds up to a geometric
// series.
TEST_F(MaterialsTest, ThickFilmsReflectWithoutInterference) {
  const dvec3 base(0.9, 0.5, 0.04);
  const double ior = 1.8;
  MetallicRoughness model{.base_color = vec3(base), .metallic = 1.0F, .roughness = 0.0F};
  model.iridescence = 1.0F;
  model.iridescence_ior = static_cast<float>(ior);
  model.iridescence_thickness_maximum = 1e8F;
  const vec3 seen = color_of_floor(make_metal(model), 1.0F, make_furnace());
  const double outer = (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1));
  for (int i = 0; i < 3; ++i) {
    const double base_ior = (1 + std::sqrt(base[i])) / (1 - std::sqrt(base[i]));
    const double inner = (base_ior - ior) * (base_ior - ior) / ((base_ior + ior) * (base_ior + ior));
    const double sum = outer + (1 - outer) * (1 - outer) * inner / (1 - outer * inner);
    EXPECT_NEAR(seen[i], sum, 64.0 * static_cast<double>(kRoundoff)) << i;
  }
}

/// Returns a wall across y with a grain along x, and a view of it from above.
world::Scene make_grain(float strength, float rotation, float roughness) {
  world::Scene scene;
  Mesh wall;
  wall.positions = {{-2, 0, -2}, {0, 0, 3}, {2, 0, -2}};
  wall.triangles = {{0, 1, 2}};
  wall.uvs = {{0, 0, 0, 0}, {0.5F, 1, 0, 0}, {1, 0, 0, 0}};
  scene.objects = {{"", wall, 0}};
  MetallicRoughness model{.metallic = 1.0F, .roughness = roughness};
  model.anisotropy = strength;
  model.anisotropy_rotation = rotation;
  scene.materials = {make_metal(model)};
  return scene;
}

// If eye and source are above, l D V is 1 / (4 pi at ab); for other directions D and V are those of the extension's
// text.
TEST_F(MaterialsTest, AGrainStretchesHighlights) {
  const float roughness = 0.3F;
  const float strength = 0.6F;
  const double across = static_cast<double>(roughness) * static_cast<double>(roughness);
  const double along = across + (1 - across) * static_cast<double>(strength) * static_cast<double>(strength);
  world::Scene scene = make_grain(strength, 0.0F, roughness);
  scene.lights = {make_sun_at(vec3(0, -1, 0))};
  Renderer renderer = make_renderer(device(), scene);
  const View view = look_along(vec3(0, -1, 0));
  const auto seen_under = [&](const vec3& to_light) {
    renderer.set_lights(std::vector{make_sun_at(glm::normalize(to_light), std::numbers::pi_v<float>)});
    return static_cast<double>(renderer.render(view).image.pixels[0].x);
  };
  const double above = seen_under(vec3(0, 1, 0));
  EXPECT_GT(seen_under(vec3(0.6F, 1, 0)), 4 * seen_under(vec3(0, 1, 0.6F)));
  EXPECT_NEAR(seen_under(vec3(0.6F, 1, 0.1F)), seen_under(vec3(-0.6F, 1, 0.1F)), 1e-5 * above);
  // The grain turns with the rotation.
  const double before = seen_under(vec3(0.5F, 1, 0.2F));
  renderer.set_materials(make_grain(strength, std::numbers::pi_v<float> / 2, roughness).materials);
  EXPECT_NEAR(seen_under(vec3(-0.2F, 1, 0.5F)), before, 1e-4 * before);
  // If two materials differ only in the grain, the heights of their highlights differ as the products of their alphas,
  // except for light that facets reflect more than once: K of white is 1 / E1.
  renderer.set_materials(make_grain(0.0F, 0.0F, roughness).materials);
  const double round = seen_under(vec3(0, 1, 0));
  const auto e1 = [](double mean_roughness) {
    return static_cast<double>(oracle::look_up_lobe_shares(1, mean_roughness).all);
  };
  const double mean = std::pow((along * along + across * across) / 2, 0.25);
  EXPECT_NEAR(above / round, across / along * e1(static_cast<double>(roughness)) / e1(mean), 1e-4);
}

// A source straight behind a matt wall has no half vector and a cosine of 0. No result may be undefined.
TEST_F(MaterialsTest, ASourceStraightBehindAGrainIsScatteredThrough) {
  world::Scene scene = make_grain(0.5F, 0.0F, 0.3F);
  auto& model = std::get<MetallicRoughness>(scene.materials[0].model);
  model.metallic = 0.0F;
  model.diffuse_transmission = 1.0F;
  scene.lights = {make_sun_at(vec3(0, -1, 0), std::numbers::pi_v<float>)};
  const vec3 seen = render(scene, look_along(vec3(0, -1, 0))).pixels[0];
  EXPECT_GT(seen.x, 0.5F);
  EXPECT_LT(seen.x, 1.0F);
  EXPECT_EQ(seen, vec3(seen.x));
}

// A white metal reflects all light from all directions, for any grain.
TEST_F(MaterialsTest, AWhiteGrainVanishesInAWhiteFurnace) {
  std::optional<Renderer> renderer;
  for (const float roughness : {0.0F, 0.2F, 1.0F}) {
    world::Scene scene = make_grain(1.0F, 0.3F, roughness);
    scene.environment.ambient = vec3(1.0F);
    if (!renderer) renderer.emplace(make_renderer(device(), scene));
    renderer->set_materials(scene.materials);
    const vec3 seen = renderer->render(look_along(-glm::normalize(vec3(0.2F, 1, 0)))).image.pixels[0];
    EXPECT_LE(max_abs_component(seen - vec3(1.0F)), 8.0F * kRoundoff) << roughness;
  }
}

// A coat has no term for light that facets reflect more than once, so a rough one may only lose light.
TEST_F(MaterialsTest, CoatedWhiteSpheresSendNoMoreThanTheyGet) {
  for (const float roughness : {0.0F, 0.05F, 0.3F, 1.0F}) {
    world::Scene scene = make_spheres(vec3(1.0F));
    for (Material& material : scene.materials) {
      auto& model = std::get<MetallicRoughness>(material.model);
      model.clearcoat = 1.0F;
      model.clearcoat_roughness = roughness;
    }
    float least = 1.0F;
    for (const vec3& pixel : render(scene, look_at_spheres()).pixels) {
      ASSERT_LE(max_component(pixel), 1.0F + 16.0F * kRoundoff) << roughness;
      least = std::min({least, pixel.x, pixel.y, pixel.z});
    }
    // Smooth facets lose nothing; the table is exact to 0.0003 except at the rim.
    EXPECT_GT(least, roughness == 0.0F ? 0.9F : 0.4F) << roughness;
  }
}

// 4096 sources give the same light, because for a lobe of this roughness they are equivalent to light from all
// directions.
TEST_F(MaterialsTest, SourcesFromEverywhereAddUpToOne) {
  constexpr int kCount = 4096;
  world::Scene scene;
  scene.objects = {{"floor", world::Plane{vec3(0), vec3(0, 1, 0)}, 0}};
  scene.materials = {make_metal({})};
  const float golden_angle = std::numbers::pi_v<float> * (3.0F - std::sqrt(5.0F));
  for (int i = 0; i < kCount; ++i) {
    const float height = 1.0F - (2.0F * static_cast<float>(i) + 1.0F) / kCount;
    const float radius = std::sqrt(1.0F - height * height);
    const float azimuth = golden_angle * static_cast<float>(i);
    const vec3 to_light = glm::normalize(vec3(radius * std::cos(azimuth), height, radius * std::sin(azimuth)));
    scene.lights.push_back(make_sun_at(to_light, 4.0F * std::numbers::pi_v<float> / kCount));
  }
  Renderer renderer = make_renderer(device(), scene);
  for (const float metallic : {0.0F, 0.5F, 1.0F}) {
    for (const float roughness : {0.5F, 0.7F, 1.0F}) {
      MetallicRoughness model;
      model.metallic = metallic;
      model.roughness = roughness;
      renderer.set_materials(std::vector{make_metal(model)});
      for (const float cosine : {0.999F, 0.8F, 0.5F, 0.25F, 0.1F}) {
        const vec3 color = renderer.render(look_along(-direction_at(cosine))).image.pixels[0];
        EXPECT_NEAR(color.x, 1.0F, 0.002F) << "metallic " << metallic << " roughness " << roughness << " at " << cosine;
      }
    }
  }
  // A sheen reduces the light of the layers below when it enters and when it leaves, so some light is lost and none is
  // added.
  for (const float roughness : {0.3F, 0.6F, 1.0F}) {
    MetallicRoughness model;
    model.metallic = 0.0F;
    model.sheen_color = vec3(1.0F);
    model.sheen_roughness = roughness;
    renderer.set_materials(std::vector{make_metal(model)});
    for (const float cosine : {0.999F, 0.8F, 0.5F, 0.25F, 0.1F}) {
      const float sent = renderer.render(look_along(-direction_at(cosine))).image.pixels[0].x;
      EXPECT_LE(sent, 1.0F + 0.002F) << roughness << " at " << cosine;
      EXPECT_GE(sent, 0.7F) << roughness << " at " << cosine;
    }
  }
}

/// The highlight of a light on a floor with black diffuse light, computed by the device and by the oracle.
struct Highlight {
  float got = 0.0F;
  oracle::Real wanted = 0;
};

class HighlightTest : public MaterialsTest {
 protected:
  HighlightTest() {
    scene_.objects = {{"floor", world::Plane{vec3(0), vec3(0, 1, 0)}, 0}};
    scene_.materials = {make_metal({})};
    scene_.lights = {make_sun_at(vec3(0, 1, 0))};
    renderer_.emplace(make_renderer(device(), scene_));
  }

  void set_model(float metallic, float roughness) {
    MetallicRoughness model;
    model.metallic = metallic;
    model.roughness = roughness;
    model.base_color = metallic > 0.0F ? vec3(0.9F, 0.6F, 0.2F) : vec3(0.0F);
    scene_.materials = {make_metal(model)};
    renderer_->set_materials(scene_.materials);
  }

  Highlight measure(const vec3& to_eye, const vec3& to_light) {
    scene_.lights = {make_sun_at(to_light)};
    renderer_->set_lights(scene_.lights);
    View view = look_along(-to_eye);
    // Any direction that is perpendicular to the view is suitable.
    view.camera.up = glm::normalize(glm::cross(to_eye, vec3(0.3F, 0.1F, 1.0F)));
    return {renderer_->render(view).image.pixels[0].x, oracle::render(scene_, view).at(0, 0).color.x};
  }

  world::Scene scene_;
  std::optional<Renderer> renderer_;
};

// Density, visibility and Fresnel's factor near the mirrored direction are exact to a relative error of 64 u + 8 u /
// alpha.
TEST_F(HighlightTest, LobesAreTheOraclesButForRounding) {
  for (const float metallic : {0.0F, 1.0F}) {
    for (const float roughness : {0.0F, 0.1F, 0.3F, 0.6F, 1.0F}) {
      set_model(metallic, roughness);
      const float alpha = std::max(roughness * roughness, 0.002F);
      for (const float cosine : {0.95F, 0.6F, 0.2F}) {
        const vec3 to_eye = glm::normalize(direction_at(cosine));
        const vec3 mirrored(-to_eye.x, to_eye.y, to_eye.z);
        for (const float aside : {0.0F, 0.3F, 1.0F, 3.0F}) {
          const vec3 to_light = glm::normalize(mirrored + std::min(aside * alpha, 0.5F) * vec3(0.3F, 0.5F, 0.8F));
          const Highlight highlight = measure(to_eye, to_light);
          const float bound = (64.0F + 8.0F / alpha) * kRoundoff;
          EXPECT_LE(std::abs(highlight.got / highlight.wanted - 1), bound)
              << "metallic " << metallic << " roughness " << roughness << " cosine " << cosine << " aside " << aside;
          EXPECT_GT(highlight.got, 0.0F);
        }
      }
    }
  }
}

// If eye and light are exchanged, a surface reflects the same light, except for the cosine to the light, which belongs
// to the source, and for light that facets reflect more than once, which depends on the eye.
TEST_F(HighlightTest, TheLobeIsReciprocal) {
  for (const float roughness : {0.2F, 0.5F, 0.9F}) {
    set_model(1.0F, roughness);
    const auto& model = std::get<MetallicRoughness>(scene_.materials[0].model);
    const float alpha = roughness * roughness;
    for (int i = 0; i < 8; ++i) {
      const float a = 0.1F + 0.1F * static_cast<float>(i);
      const float b = 0.95F - 0.07F * static_cast<float>(i);
      const vec3 there = glm::normalize(direction_at(a));
      const vec3 back = glm::normalize(direction_at(b) * vec3(-1, 1, 1) + vec3(0, 0, 0.3F));
      // Returns the factor that depends only on the direction to the eye.
      const auto share_of = [&](const vec3& to_eye, const vec3& to_light) {
        const oracle::LobeAngles angles = oracle::angles_of({0, 1, 0}, glm::normalize(oracle::Vector(to_eye)),
                                                            glm::normalize(oracle::Vector(to_light)));
        const oracle::Lobe plain(model, oracle::Vector(1), oracle::LobeShares());
        const oracle::Lobe full(model, oracle::Vector(1), oracle::look_up_lobe_shares(angles.v, roughness));
        return angles.l * full.highlight(angles).x / plain.highlight(angles).x;
      };
      const oracle::Real one = measure(there, back).got / share_of(there, back);
      const oracle::Real other = measure(back, there).got / share_of(back, there);
      EXPECT_LE(std::abs(one / other - 1), (32.0F + 16.0F / alpha) * kRoundoff) << roughness << " " << i;
    }
  }
}

// In KHR_materials_ior, an index of 0 reflects everything, from every side.
TEST_F(MaterialsTest, AnIndexOfZeroIsAMirror) {
  MetallicRoughness model{.base_color = vec3(0.0F), .metallic = 0.0F, .roughness = 0.0F, .ior = 0.0F};
  for (const float cosine : {1.0F, 0.5F, 0.1F}) {
    const vec3 color = color_of_floor(make_metal(model), cosine, make_furnace());
    EXPECT_LE(max_abs_component(color - vec3(1.0F)), 8.0F * kRoundoff) << cosine;
  }
  // KHR_materials_specular colours the reflection or removes it; without it all light is the body's.
  model.specular_color = vec3(1.0F, 0.5F, 0.0F);
  EXPECT_LE(max_abs_component(color_of_floor(make_metal(model), 1.0F, make_furnace()) - model.specular_color),
            8.0F * kRoundoff);
  model.base_color = vec3(0.5F);
  model.specular = 0.0F;
  EXPECT_EQ(color_of_floor(make_metal(model), 0.1F, make_furnace()), vec3(0.5F));
}

TEST_F(MaterialsTest, WithoutSpecularStrengthASurfaceIsMatt) {
  MetallicRoughness model{.base_color = vec3(0.5F), .metallic = 0.0F, .roughness = 0.3F};
  world::Scene scene;
  scene.lights = {make_sun_at(direction_at(0.5F) * vec3(-1, 1, 1))};
  const vec3 glossy = color_of_floor(make_metal(model), 0.5F, scene);
  model.specular = 0.0F;
  const vec3 matt = color_of_floor(make_metal(model), 0.5F, scene);
  EXPECT_NEAR(matt.x, 0.5F * std::numbers::inv_pi_v<float> * 0.5F, 1e-7F);
  EXPECT_GT(glossy.x, 2.0F * matt.x);
}

// A black metal reflects as glass without a body does: only at grazing incidence (Schlick's factor, F90 = 1).
TEST_F(MaterialsTest, BlackMetalReflectsFromTheSideAlone) {
  const MetallicRoughness model{.base_color = vec3(0.0F), .metallic = 1.0F, .roughness = 0.0F};
  for (const float cosine : {1.0F, 0.7F, 0.3F, 0.05F}) {
    const vec3 color = color_of_floor(make_metal(model), cosine, make_furnace());
    // The tolerance is the table's error.
    EXPECT_NEAR(color.x, std::pow(1.0F - cosine, 5.0F), 0.005F) << cosine;
  }
}

/// Returns a triangle across the view from +y, with the same colour at all corners.
Mesh make_colored_mesh(const vec3& color) {
  Mesh mesh;
  mesh.positions = {{-2, 0, -2}, {0, 0, 3}, {2, 0, -2}};
  mesh.triangles = {{0, 1, 2}};
  mesh.colors = {vec4(color, 1), vec4(color, 1), vec4(color, 1)};
  return mesh;
}

TEST_F(MaterialsTest, VertexColorsAreFactorsOfTheBaseColor) {
  world::Scene scene = make_furnace(0.5F);
  scene.lights = {make_sun_at(vec3(0, 1, 0), 2.0F)};
  const View view = look_along(-glm::normalize(vec3(0.2F, 1, 0)));
  const auto color_of = [&](const Material& material, const vec3& vertex_color) {
    scene.materials = {material};
    scene.objects = {{"", make_colored_mesh(vertex_color), 0}};
    return render(scene, view).pixels[0];
  };
  for (const float metallic : {0.0F, 0.5F, 1.0F}) {
    MetallicRoughness model{.base_color = vec3(1, 0.5F, 0.75F), .metallic = metallic, .roughness = 0.6F};
    const vec3 by_vertices = color_of(make_metal(model), vec3(0.25F, 0.5F, 1));
    const vec3 plain = color_of(make_metal(model), vec3(1));
    model.base_color = vec3(0.25F, 0.25F, 0.75F);
    const vec3 by_base = color_of(make_metal(model), vec3(1));
    EXPECT_LE(max_abs_component(by_vertices - by_base), 32.0F * kRoundoff) << metallic;
    EXPECT_GT(plain.x, 1.5F * by_base.x) << metallic;
    // With a base colour of more than 1, the surface would reflect more light than it gets.
    model.base_color = vec3(1);
    const vec3 white = color_of(make_metal(model), vec3(1));
    EXPECT_LE(max_abs_component(color_of(make_metal(model), vec3(4)) - white), 32.0F * kRoundoff) << metallic;
  }
  Material unlit;
  unlit.model = Unlit{vec3(1, 0.5F, 2)};
  EXPECT_LE(max_abs_component(color_of(unlit, vec3(0.5F, 0.5F, 3)) - vec3(0.5F, 0.25F, 6)), 32.0F * kRoundoff);
}

TEST_F(MaterialsTest, NoLightTouchesTheUnlit) {
  Material unlit;
  unlit.model = Unlit{vec3(0.3F, 0.6F, 0.9F)};
  unlit.emissive = vec3(0.5F, 0, 0);
  const vec3 alone = color_of_floor(unlit, 0.6F, world::Scene());
  EXPECT_EQ(alone, vec3(0.3F, 0.6F, 0.9F) + vec3(0.5F, 0, 0));
  world::Scene lit = make_furnace(3.0F);
  lit.lights = {make_sun_at(vec3(0, 1, 0), 5.0F), make_headlight()};
  EXPECT_EQ(color_of_floor(unlit, 0.6F, lit), alone);
}

}  // namespace
}  // namespace promin
