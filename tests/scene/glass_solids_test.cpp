// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/glass_solids.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "measure/meshes.h"
#include "measure/random.h"

namespace promin {
namespace {

using measure::Random;

/// Returns a scene of balls of glass, of which some share a mesh. Each has a material of its own.
world::Scene make_balls(uint32_t count) {
  Random random(4);
  world::Scene scene;
  scene.meshes.push_back(std::get<Mesh>(measure::make_wavy_sphere(200).objects[0].shape));
  for (uint32_t i = 0; i < count; ++i) {
    scene.materials.emplace_back().model = MetallicRoughness{.metallic = 0.0F, .transmission = 1.0F, .thickness = 1.0F};
    const dvec3 center = 2.0 * random.direction();
    if (i % 3 == 0) {
      scene.objects.push_back({"", world::Sphere{.center = vec3(center), .radius = 1.2F}, i});
      continue;
    }
    scene.objects.push_back({"", world::NotDrawn{}, i});
    dmat4 map = glm::translate(dmat4(1.0), center);
    if (i % 2 == 0) map[0] *= -1.3;
    scene.instances.push_back({i, 0, world::map_of(map)});
  }
  return scene;
}

TEST(GlassSolidsTest, MovedInstancesAreThoseOfTheMovedScene) {
  world::Scene scene = make_balls(12);
  const auto before = std::make_shared<const GlassSolids>(scene);
  EXPECT_EQ(GlassSolids::moved(before, {}), before);
  const std::pair<uint32_t, dmat4> sphere(3, dmat4(1.0));
  EXPECT_EQ(GlassSolids::moved(before, {&sphere, 1}), before) << "a sphere is not an instance";

  Random random(5);
  std::vector<std::pair<uint32_t, dmat4>> moved;
  for (world::Instance& instance : scene.instances) {
    if (instance.object % 4 == 0) continue;
    const dmat4 map = glm::scale(glm::translate(dmat4(1.0), 2.0 * random.direction()), dvec3(random.uniform(0.5, 2.0)));
    instance.map = world::map_of(map);
    moved.emplace_back(instance.object, map);
  }
  const std::shared_ptr<const GlassSolids> after = GlassSolids::moved(before, moved);
  const GlassSolids fresh(scene);
  size_t changed = 0;
  for (int i = 0; i < 1000; ++i) {
    const vec3 point(random.uniform(0.0, 3.0) * random.direction());
    const std::vector<uint32_t> around = after->materials_around(point);
    EXPECT_EQ(around, fresh.materials_around(point));
    changed += around != before->materials_around(point) ? 1 : 0;
  }
  EXPECT_GT(changed, 200U);
}

}  // namespace
}  // namespace promin
