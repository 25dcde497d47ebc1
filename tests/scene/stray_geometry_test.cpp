// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/stray_geometry.h"

#include <gtest/gtest.h>

#include "promin/framing.h"

namespace promin {
namespace {

/// Adds a box of this size around a point.
void add_box(Scene& scene, const dvec3& center, const dvec3& size = dvec3(1.0)) {
  dmat4 place(1.0);
  for (int axis = 0; axis < 3; ++axis) place[axis][axis] = size[axis];
  place[3] = dvec4(center, 1.0);
  scene.add("box", Box{}, 0, place);
}

void add_corner_triangle(Scene& scene, const vec3& place, float size) {
  Mesh mesh;
  mesh.positions = {place, place + vec3(size, 0, 0), place + vec3(0, size, 0)};
  mesh.triangles = {{0, 1, 2}};
  scene.add("triangle", mesh);
}

Scene make_scene_of_a_box() {
  Scene scene;
  scene.materials.resize(1);
  add_box(scene, dvec3(10, 20, 30));
  return scene;
}

TEST(StrayGeometry, IsLeftOutWhereItIsFarAndSmall) {
  Scene scene = make_scene_of_a_box();
  const Bounds box = find_main_part(scene).bounds;
  add_corner_triangle(scene, vec3(2000, 0, 0), 0.01F);
  add_corner_triangle(scene, vec3(0, -1e9F, 0), 0.01F);
  const MainPart part = find_main_part(scene);
  EXPECT_EQ(part.stray_count, 2U);
  EXPECT_EQ(part.bounds.lo, box.lo);
  EXPECT_EQ(part.bounds.hi, box.hi);
  const Camera camera = frame_scene(scene, 1.0F);
  const Camera alone = frame_scene(make_scene_of_a_box(), 1.0F);
  EXPECT_EQ(camera.eye, alone.eye);
}

TEST(StrayGeometry, IsKeptWhereItIsNearOrLarge) {
  Scene near = make_scene_of_a_box();
  add_corner_triangle(near, vec3(60, 20, 30), 0.01F);
  EXPECT_EQ(find_main_part(near).stray_count, 0U) << "1/50 of the size";
  EXPECT_EQ(find_main_part(near).bounds.hi.x, 60.01F);

  Scene large = make_scene_of_a_box();
  add_corner_triangle(large, vec3(2000, 0, 0), 1.0F);
  EXPECT_EQ(find_main_part(large).stray_count, 0U) << "a half of 6.5 units of surface";

  Scene apart = make_scene_of_a_box();
  add_box(apart, dvec3(5000, 20, 30));
  EXPECT_EQ(find_main_part(apart).stray_count, 0U);

  Scene bridged = make_scene_of_a_box();
  add_box(bridged, dvec3(0, 0, 0), dvec3(1e-4, 1e4, 1.0));
  EXPECT_EQ(find_main_part(bridged).stray_count, 0U);
}

TEST(StrayGeometry, OfNothingAndOfPointsIsNone) {
  Scene scene;
  EXPECT_TRUE(find_main_part(scene).bounds.is_empty());
  scene.materials.resize(1);
  add_corner_triangle(scene, vec3(1), 0.0F);
  add_corner_triangle(scene, vec3(2), 0.0F);
  EXPECT_EQ(find_main_part(scene).stray_count, 0U);
  scene.add("floor", Plane{});
  EXPECT_EQ(find_main_part(scene).stray_count, 0U);
}

}  // namespace
}  // namespace promin
