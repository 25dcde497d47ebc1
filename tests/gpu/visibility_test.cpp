// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What a pixel shows against the oracle's brute force in long double: objects get a colour each that nothing changes,
// so that a picture is a map of object numbers; and one light of diffuse white, so that it is a map of shadows.
#include <gtest/gtest.h>

#include <cmath>

#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "oracle/oracle.h"
#include "render/renderer.h"

namespace promin {
namespace {

const uvec2 kSize(96, 72);

/// numerics.md, tier 1.
constexpr double kMismatchShare = 0.0005;

oracle::Ray camera_ray(const View& view, uint32_t x, uint32_t y) {
  using oracle::Vector;
  const Vector look(view.camera.look);
  const Vector up(view.camera.up);
  const Vector right = glm::cross(look, up);
  const oracle::Real pixel =
      2.0L * std::tan(0.5L * static_cast<oracle::Real>(view.camera.yfov)) / static_cast<oracle::Real>(view.size.y);
  const oracle::Real dx = (x + 0.5L - view.size.x / 2.0L) * pixel;
  const oracle::Real dy = (view.size.y / 2.0L - y - 0.5L) * pixel;
  return {Vector(view.camera.eye), look + dx * right + dy * up, view.camera.near, oracle::kInfinity};
}

class VisibilityTest : public test::DeviceTest {
 protected:
  static Image render(const Scene& scene, const View& view) { return Renderer(device(), scene).render(view).image; }
};

TEST_F(VisibilityTest, EachPixelShowsTheNearestObject) {
  Scene scene = test::make_scene_of_everything();
  scene.lights.clear();
  scene.background = vec3(-1.0F);
  scene.materials.assign(scene.objects.size(), Material());
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    scene.materials[i].emissive = vec3(static_cast<float>(i));
    scene.materials[i].ambient = vec3(0.0F);
    scene.objects[i].material = i;
  }
  const View view = test::make_view(kSize);
  const Image picture = render(scene, view);
  uint32_t mismatches = 0;
  for (uint32_t y = 0; y < kSize.y; ++y) {
    for (uint32_t x = 0; x < kSize.x; ++x) {
      const int32_t expected = oracle::find_nearest_hit(scene, camera_ray(view, x, y)).object;
      if (static_cast<int32_t>(picture.at(x, y).x) == expected) continue;
      ++mismatches;
      std::printf("pixel %u, %u shows object %g, not %d\n", x, y, picture.at(x, y).x, expected);
    }
  }
  EXPECT_LE(mismatches, kMismatchShare * kSize.x * kSize.y);
}

TEST_F(VisibilityTest, EachPixelIsLitUnlessSomethingLiesBetween) {
  Scene scene = test::make_scene_of_everything();
  scene.objects.resize(scene.objects.size() - 1);
  std::erase_if(scene.objects, [](const Object& o) { return std::holds_alternative<Mesh>(o.shape); });
  scene.lights.resize(1);
  scene.background = vec3(0.0F);
  scene.ambient = vec3(0.0F);
  for (Material& material : scene.materials) {
    material = Material();
    material.diffuse = vec3(1.0F);
    material.reflection = vec3(0.0F);
  }
  const View view = test::make_view(kSize);
  const Image picture = render(scene, view);
  const oracle::Vector light(scene.lights[0].position);
  uint32_t mismatches = 0;
  uint32_t lit_count = 0;
  for (uint32_t y = 0; y < kSize.y; ++y) {
    for (uint32_t x = 0; x < kSize.x; ++x) {
      const oracle::Ray ray = camera_ray(view, x, y);
      const oracle::Hit hit = oracle::find_nearest_hit(scene, ray);
      if (!hit.exists()) continue;
      oracle::Vector normal = hit.normal;
      if (glm::dot(normal, ray.direction) > 0) normal = -normal;
      const oracle::Vector point = ray.origin + hit.t * ray.direction + 1e-9L * normal;
      const oracle::Vector to_light = light - point;
      const oracle::Real cosine = glm::dot(normal, to_light) / glm::length(to_light);
      const bool is_lit = cosine > 0 && !oracle::is_occluded(scene, {point, to_light, 0, 1});
      const oracle::Real expected = is_lit ? cosine * scene.lights[0].diffuse.x : 0;
      lit_count += is_lit ? 1 : 0;
      if (std::abs(picture.at(x, y).x - expected) <= 1e-4L) continue;
      ++mismatches;
      std::printf("pixel %u, %u is %g, not %Lg\n", x, y, picture.at(x, y).x, expected);
    }
  }
  EXPECT_GT(lit_count, 1000U);
  EXPECT_LE(mismatches, kMismatchShare * kSize.x * kSize.y);
}

}  // namespace
}  // namespace promin
