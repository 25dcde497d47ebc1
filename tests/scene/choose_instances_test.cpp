// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/choose_instances.h"

#include <gmock/gmock.h>

#include <glm/gtc/quaternion.hpp>

#include "promin/error.h"
#include "promin/motion.h"

namespace promin {
namespace {

using testing::Each;
using testing::ElementsAre;

/// Returns a mesh around the origin with this number of triangles.
Mesh make_fan(uint32_t triangles) {
  Mesh mesh;
  mesh.positions.emplace_back(0.0F);
  for (uint32_t i = 0; i <= triangles; ++i) {
    const double angle = 6.28 * i / triangles;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.01 * (i % 3));
  }
  for (uint32_t i = 1; i <= triangles; ++i) mesh.triangles.emplace_back(0, i, i + 1);
  return mesh;
}

Scene make_shared_fans(uint32_t triangles, size_t objects) {
  Scene scene;
  scene.materials.emplace_back();
  scene.add("fan", make_fan(triangles));
  add_instances(scene, 0, std::vector<dmat4>(objects - 1, dmat4(1.0)));
  return scene;
}

TEST(ChooseInstancesTest, AutoTakesMeshesThatSaveEnough) {
  EXPECT_THAT(choose_instances(make_shared_fans(8192, 3), Instancing::kAuto), Each(true));
  EXPECT_THAT(choose_instances(make_shared_fans(8191, 3), Instancing::kAuto), Each(false));
  EXPECT_THAT(choose_instances(make_shared_fans(64, 257), Instancing::kAuto), Each(true));
  EXPECT_THAT(choose_instances(make_shared_fans(63, 1000), Instancing::kAuto), Each(false));
  EXPECT_THAT(choose_instances(make_shared_fans(8192, 3), Instancing::kNone), Each(false));
  EXPECT_THAT(choose_instances(make_shared_fans(1, 1), Instancing::kAll), Each(true));
}

TEST(ChooseInstancesTest, SomeObjectsAreNeverInstances) {
  Scene scene = make_shared_fans(8, 6);
  scene.objects[1].geometry = Object::kNoGeometry;
  // Scales along the mesh's own axes are no problem, but shear is.
  scene.objects[2].world_from_object[0] *= -1e6;
  const dmat4 turn = glm::mat4_cast(glm::angleAxis(0.7, glm::normalize(dvec3(1, 2, 3))));
  scene.objects[3].world_from_object = glm::transpose(turn) * scene.objects[2].world_from_object * turn;
  scene.objects[4].world_from_object[1] *= 0x1p41;
  scene.add("ball", Sphere());
  Mesh far = make_fan(8);
  for (vec3& p : far.positions) p.x += 20.0F;
  scene.add("far", far);
  EXPECT_THAT(choose_instances(scene, Instancing::kAll),
              ElementsAre(true, false, true, false, false, true, false, false));
  EXPECT_LE(skeel_condition(scene.objects[2].world_from_object), 1.0 + 1e-9);
  EXPECT_LE(skeel_condition(turn * scene.objects[2].world_from_object), 3.0);
  EXPECT_GT(skeel_condition(scene.objects[3].world_from_object), kMostInstanceCondition);
}

/// The choice must not change within a film, because other choices give other bits.
TEST(ChooseInstancesTest, AHiddenObjectOfAFileCounts) {
  Scene scene = make_shared_fans(8192, 3);
  Motion motion;
  motion.objects = {{.geometry = 0}, {.geometry = 0}, {.geometry = 0}};
  scene.motion = std::make_shared<const Motion>(motion);
  scene.objects[1].geometry = Object::kNoGeometry;
  EXPECT_THAT(choose_instances(scene, Instancing::kAuto), ElementsAre(true, false, true));
  scene.motion = nullptr;
  EXPECT_THAT(choose_instances(scene, Instancing::kAuto), Each(false));
}

TEST(AddInstancesTest, AddsObjectsThatShareAGeometry) {
  Scene scene = make_shared_fans(4, 1);
  const dmat4 moved = dmat4(2.0);
  add_instances(scene, 0, std::vector<dmat4>{moved, dmat4(1.0)});
  ASSERT_EQ(scene.objects.size(), 3U);
  EXPECT_EQ(scene.geometries.size(), 1U);
  EXPECT_EQ(scene.objects[1].name, "fan");
  EXPECT_EQ(scene.objects[1].geometry, 0U);
  EXPECT_EQ(scene.objects[1].world_from_object, moved);
  EXPECT_THROW(add_instances(scene, 3, std::vector<dmat4>{moved}), InputError);
}

}  // namespace
}  // namespace promin
