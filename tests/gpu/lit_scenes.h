// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdio>

#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "gpu/ways_of_tracing.h"
#include "oracle/compare_picture.h"
#include "scene/world_scene.h"
#include "trace/render/renderer_impl.h"

/// A fixture, scenes and views that tests of sampled light share.
namespace promin::test {

/// Renders pictures of sampled light on the shared device.
class SampledLightTest : public DeviceTest {
 protected:
  static Renderer renderer_of(const world::Scene& scene, const TunedRendererOptions& options = {}) {
    return make_renderer(device(), scene, options);
  }
  static dvec3 mean_of(const world::Scene& scene, const View& view) {
    const Image image = renderer_of(scene).render(view).image;
    dvec3 sum(0.0);
    for (const vec3& pixel : image.pixels) sum += dvec3(pixel);
    return sum / static_cast<double>(image.pixels.size());
  }
  static oracle::PictureReport report_of(const world::Scene& scene, const oracle::Picture& truth, const Image& image,
                                         const oracle::PictureBounds& bounds) {
    oracle::PictureReport report = compare_picture(scene, truth, image, {}, bounds);
    std::printf("%s\n", report.summary(scene).c_str());
    return report;
  }
  /// Expects that each way of tracing, and a crop, give the bits of the picture. Returns the picture.
  static Image expect_same_bits(const world::Scene& scene, const View& view) {
    const Image expected = renderer_of(scene).render(view).image;
    for (const TunedRendererOptions& way : ways_of_tracing()) {
      EXPECT_TRUE(has_same_bits(renderer_of(scene, way).render(view).image, expected));
    }
    View crop = view;
    crop.crop = PixelWindow{uvec2(13, 7), uvec2(29, 22)};
    const Image part = renderer_of(scene).render(crop).image;
    for (uint32_t y = 0; y < part.size.y; ++y) {
      for (uint32_t x = 0; x < part.size.x; ++x) {
        EXPECT_EQ(part.pixels[y * part.size.x + x], expected.pixels[(y + 7) * view.size.x + x + 13]);
      }
    }
    return expected;
  }
};

inline Material make_clay(const vec3& color) {
  Phong phong;
  phong.ambient = phong.diffuse = color;
  return {.name = "", .model = phong};
}

inline Material make_physical(const vec3& color, float metallic, float roughness) {
  MetallicRoughness model;
  model.base_color = color;
  model.metallic = metallic;
  model.roughness = roughness;
  return {.name = "", .model = model};
}

/// A floor with balls of several materials: clay, a mirror, rough metal, and a coat. The floor is a rough dielectric.
inline world::Scene make_lit_balls() {
  world::Scene scene;
  Material mirror = make_clay(vec3(0.1F));
  std::get<Phong>(mirror.model).reflection = vec3(0.7F);
  Material coated = make_physical(vec3(0.2F, 0.3F, 0.7F), 0.0F, 0.8F);
  auto& coat = std::get<MetallicRoughness>(coated.model);
  coat.clearcoat = 1.0F;
  coat.clearcoat_roughness = 0.25F;
  Material cloth = make_physical(vec3(0.4F, 0.1F, 0.1F), 0.0F, 0.9F);
  auto& sheen = std::get<MetallicRoughness>(cloth.model);
  sheen.sheen_color = vec3(0.6F, 0.5F, 0.9F);
  sheen.sheen_roughness = 0.4F;
  Material leaf = make_physical(vec3(0.3F, 0.6F, 0.2F), 0.0F, 0.6F);
  auto& through = std::get<MetallicRoughness>(leaf.model);
  through.diffuse_transmission = 0.5F;
  through.diffuse_transmission_color = vec3(0.5F, 0.9F, 0.2F);
  scene.materials = {make_physical(vec3(0.8F, 0.7F, 0.6F), 0.0F, 0.5F),
                     make_clay(vec3(0.3F, 0.5F, 0.8F)),
                     mirror,
                     make_physical(vec3(0.9F, 0.7F, 0.4F), 1.0F, 0.3F),
                     coated,
                     cloth,
                     leaf};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}};
  for (uint32_t i = 0; i < 6; ++i) {
    const vec3 center(-1.4F + 1.4F * static_cast<float>(i % 3), 0.4F, i < 3 ? 0.3F : -0.9F);
    scene.objects.push_back({"ball", world::Sphere{center, 0.4F + 0.03F * static_cast<float>(i)}, i + 1});
  }
  return scene;
}

inline View make_direct_view(uvec2 size = uvec2(32, 24)) {
  View view;
  view.size = size;
  view.camera.eye = vec3(0.0F, 2.2F, 4.0F);
  view.camera.look = glm::normalize(vec3(0.0F, -0.48F, -1.0F));
  view.camera.up = glm::normalize(glm::cross(glm::cross(view.camera.look, vec3(0, 1, 0)), view.camera.look));
  view.max_depth = 2;
  view.mode.integrator = Integrator::kDirect;
  return view;
}

/// Returns a view that sees one point of the plane y = 0.
inline View make_point_view(const vec3& point, float height = 0.2F) {
  View view = make_direct_view(uvec2(8));
  view.camera.eye = point + vec3(0.0F, height, 0.0F);
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.camera.yfov = 0.002F;
  view.samples_per_pixel = 256;
  return view;
}

inline world::Scene make_open_floor(const vec3& albedo = vec3(1.0F)) {
  world::Scene scene;
  scene.materials = {make_clay(albedo)};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}};
  return scene;
}

}  // namespace promin::test
