// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests compare pictures and hits of instances with those of copied meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

#include "gpu/device_fixture.h"
#include "gpu/gallery.h"
#include "gpu/test_scenes.h"
#include "measure/meshes.h"
#include "measure/random.h"
#include "measure/ray_sets.h"
#include "promin/caster.h"
#include "trace/render/caster_access.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

using measure::Random;

/// Returns the same scene with every mesh as an instance. Each has another turn and scale, and every second one is
/// mirrored.
world::Scene with_instances(world::Scene scene) {
  Random random(3);
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&scene.objects[i].shape);
    if (mesh == nullptr || mesh->triangles.empty()) continue;
    Bounds box;
    for (const vec3& p : mesh->positions) box.extend(p);
    dmat4 map = glm::mat4_cast(glm::angleAxis(random.uniform(-3.0, 3.0), random.direction()));
    for (int axis = 0; axis < 3; ++axis) map[axis] *= random.uniform(0.5, 3.0);
    if (i % 2 == 0) map[1] *= -1.0;
    map[3] = dvec4(dvec3(box.center()), 1.0);
    scene.meshes.push_back(world::place(*mesh, glm::inverse(map)));
    scene.instances.push_back({i, static_cast<uint32_t>(scene.meshes.size() - 1), glm::dmat4x3(map)});
    scene.objects[i].shape = world::NotDrawn{};
  }
  return scene;
}

class InstancesTest : public DeviceTest {
 protected:
  static void expect_same_picture(const world::Scene& flat, const View& view) {
    TunedRendererOptions options;
    options.aovs.object = options.aovs.normal = options.aovs.position = true;
    const RenderResult a = make_renderer(device(), flat, options).render(view);
    const world::Scene scene = with_instances(flat);
    ASSERT_FALSE(scene.instances.empty());
    const RenderResult b = make_renderer(device(), scene, options).render(view);
    const size_t count = a.image.pixels.size();
    ASSERT_EQ(b.image.pixels.size(), count);
    double sum = 0.0;
    size_t failed = 0;
    size_t others = 0;
    for (size_t i = 0; i < count; ++i) {
      const vec3 difference = glm::abs(a.image.pixels[i] - b.image.pixels[i]);
      const float largest = std::max({difference.x, difference.y, difference.z});
      sum += largest;
      failed += largest <= 0.01F ? 0 : 1;
      others += a.aovs.object[i] != b.aovs.object[i] ? 1 : 0;
    }
    // Rounding selects another surface at some edges and in some mirrors.
    EXPECT_LE(failed, count / 250);
    EXPECT_LE(sum / static_cast<double>(count), 5e-4);
    EXPECT_LE(others, count / 500);
  }
};

View gallery_view() {
  View view = make_gallery_view({96, 64});
  view.samples_per_pixel = 4;
  return view;
}

TEST_F(InstancesTest, TexturesAndTangents) {
  expect_same_picture(make_gallery_of_metallic_roughness(), gallery_view());
}

TEST_F(InstancesTest, MasksAndBlending) {
  expect_same_picture(make_gallery_of_alpha(), gallery_view());
}

TEST_F(InstancesTest, Glass) {
  View view = make_view({96, 64});
  view.samples_per_pixel = 2;
  expect_same_picture(make_scene_of_glass(), view);
}

/// The camera is inside a mesh of glass, whose instance is mirrored.
TEST_F(InstancesTest, CameraInGlass) {
  world::Scene scene = make_scene_of_everything(20);
  Material glass;
  glass.model = MetallicRoughness{.transmission = 1.0F};
  auto& model = std::get<MetallicRoughness>(glass.model);
  model.thickness = 1.0F;
  model.attenuation_distance = 2.0F;
  model.attenuation_color = vec3(0.3F, 0.9F, 0.5F);
  model.ior = 1.5F;
  scene.materials.push_back(glass);
  View view = make_view({48, 32});
  Mesh ball = std::get<Mesh>(measure::make_wavy_sphere(2000).objects[0].shape);
  for (vec3& p : ball.positions) p = view.camera.eye + 0.5F * p;
  if (scene.objects.size() % 2 != 0) scene.objects.push_back({"", world::NotDrawn{}});
  scene.objects.push_back({"glass", ball, static_cast<uint32_t>(scene.materials.size() - 1)});
  expect_same_picture(scene, view);
}

TEST_F(InstancesTest, CrossingsAndAnyHits) {
  const world::Scene flat = measure::make_wavy_sphere(3000);
  const world::Scene scene = with_instances(flat);
  Random random(5);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    rays.push_back(measure::ray_towards(4.0 * random.direction(), 0.9 * random.direction()));
    // A light at a finite distance.
    if (i % 2 == 0) rays.back().tmax = static_cast<float>(random.uniform(1.0, 6.0));
  }
  Caster one = make_caster(device(), flat);
  Caster other = make_caster(device(), scene);
  const auto count_others = [](const auto& a, const auto& b, const auto& is_same) {
    size_t count = 0;
    for (size_t i = 0; i < a.size(); ++i) count += is_same(a[i], b[i]) ? 0 : 1;
    return count;
  };
  std::vector<std::vector<int32_t>> counts(2, std::vector<int32_t>(rays.size()));
  one.count(rays, counts[0]);
  other.count(rays, counts[1]);
  EXPECT_LE(count_others(counts[0], counts[1], std::equal_to<>()), 4U);
  std::vector<std::vector<Hit>> hits(2, std::vector<Hit>(rays.size()));
  const auto is_same = [](const Hit& a, const Hit& b) { return a.object == b.object && a.primitive == b.primitive; };
  one.cast(rays, hits[0]);
  other.cast(rays, hits[1]);
  EXPECT_LE(count_others(hits[0], hits[1], is_same), 4U);
  std::vector<Hit> any(rays.size());
  other.cast(rays, any, HitQuery::kAny);
  const auto are_both_hits = [](const Hit& a, const Hit& b) { return (a.object >= 0) == (b.t == 0.0F); };
  EXPECT_EQ(count_others(hits[1], any, are_both_hits), 0U) << "any-hit rays agree with nearest hits exactly";
  size_t listed = 0;
  other.list(rays, [&](const HitList& list) { listed += list.hits.size(); });
  size_t counted = 0;
  for (const int32_t count : counts[1]) counted += static_cast<size_t>(count);
  EXPECT_EQ(listed, counted);
}

/// Kernels that can trace instances give the same bits for a scene without instances.
TEST_F(InstancesTest, FeatureDoesNotChangeOtherScenes) {
  const world::Scene scene = make_scene_of_everything(50);
  const View view = make_view({64, 48});
  TunedRendererOptions options;
  const Image plain = make_renderer(device(), scene, options).render(view).image;
  options.more_features = layout::FEATURE_INSTANCES;
  EXPECT_TRUE(has_same_bits(make_renderer(device(), scene, options).render(view).image, plain));
}

}  // namespace
}  // namespace promin::test
