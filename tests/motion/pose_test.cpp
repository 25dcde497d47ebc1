// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/motion.h"

#include <gmock/gmock.h>

#include <cmath>

#include "promin/validate.h"
#include "support/moving_gltf.h"
#include "support/pose_oracle.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using nlohmann::json;
using test::animate;
using test::OraclePoint;

/// Compares poses of small documents with the oracle.
class PoseTest : public SceneFolder {
 protected:
  Scene load() { return load_scene(write("scene.gltf", gltf_.text())); }

  /// Compares the poses at many times, among them those before the first key and after the last one.
  void expect_poses(const std::vector<uint32_t>& animations, double last_s) {
    const Scene scene = load();
    ASSERT_NE(scene.motion, nullptr);
    for (int i = -1; i <= 17; ++i) {
      const double time_s = last_s * i / 16.0;
      SCOPED_TRACE(time_s);
      const std::vector<size_t> clips(animations.begin(), animations.end());
      const Scene posed = scene_at(scene, {.animations = animations, .time_s = time_s});
      expect_same(posed, test::pose_by_specification(gltf_, clips, static_cast<long double>(time_s)));
      EXPECT_TRUE(validate(posed).empty());
    }
    expect_same(scene_at(scene, {}), test::pose_by_specification(gltf_, {}, 0));
    expect_same(scene, test::pose_by_specification(gltf_, {}, 0));
  }

  static void expect_same(const Scene& scene, const std::vector<std::vector<OraclePoint>>& wanted) {
    const world::Scene flat = world::flatten(scene);
    ASSERT_EQ(flat.objects.size(), wanted.size());
    long double size = 0;
    for (const auto& corners : wanted) {
      for (const OraclePoint& corner : corners) {
        for (const long double number : corner) size = std::max(size, std::abs(number));
      }
    }
    for (size_t i = 0; i < wanted.size(); ++i) {
      SCOPED_TRACE("object " + std::to_string(i));
      if (wanted[i].empty()) {
        EXPECT_EQ(scene.objects[i].geometry, Object::kNoGeometry);
        continue;
      }
      ASSERT_NE(scene.objects[i].geometry, Object::kNoGeometry);
      expect_corners(mesh_of(flat, i), flat.objects[i].is_rewound, wanted[i], size);
    }
  }

  static void expect_corners(const Mesh& mesh, bool is_rewound, const std::vector<OraclePoint>& wanted,
                             long double size) {
    const std::vector<vec3> corners = corners_of(mesh);
    ASSERT_EQ(corners.size(), wanted.size());
    for (size_t i = 0; i < wanted.size(); ++i) {
      const size_t place = is_rewound ? i - i % 3 + (3 - i % 3) % 3 : i;
      for (int axis = 0; axis < 3; ++axis) {
        const auto got = static_cast<long double>(corners[place][axis]);
        // Each coordinate is rounded to fp32 once or twice.
        ASSERT_LE(std::abs(got - wanted[i][static_cast<size_t>(axis)]), 2e-7L * size) << "corner " << i;
      }
    }
  }

  GltfBuilder gltf_ = triangle_gltf();
};

TEST_F(PoseTest, TranslationRotationAndScaleMoveANode) {
  animate(gltf_, 0, "/nodes/0/translation", {0.5F, 1, 3}, {0, 0, 0, 1, 2, 3, -4, 5, 6}, "VEC3");
  animate(gltf_, 0, "/nodes/0/rotation", {0, 2, 3}, {0, 0, 0, 1, 0.6F, 0, 0, 0.8F, 0, 0.28F, 0, -0.96F}, "VEC4");
  animate(gltf_, 0, "/nodes/0/scale", {1, 2}, {1, 1, 1, 2, 3, 0.5F}, "VEC3");
  expect_poses({0}, 3.0);
}

TEST_F(PoseTest, StepsHoldTheLastKey) {
  animate(gltf_, 0, "/nodes/0/translation", {0, 1, 2}, {0, 0, 0, 1, 2, 3, -4, 5, 6}, "VEC3", "STEP");
  animate(gltf_, 0, "/nodes/0/rotation", {0, 1.5F}, {0, 0, 0, 2, 0.6F, 0, 0, 0.8F}, "VEC4", "STEP");
  expect_poses({0}, 2.0);
}

TEST_F(PoseTest, SplinesUseTangentsTimesTheInterval) {
  animate(gltf_, 0, "/nodes/0/translation", {0, 0.5F, 3}, {0,  0, 0, 0, 0, 0, 1, -1, 2,  //
                                                           3,  0, 1, 1, 2, 3, 0, 1,  0,  //
                                                           -2, 1, 1, 4, 4, 4, 0, 0,  0},
          "VEC3", "CUBICSPLINE");
  animate(gltf_, 0, "/nodes/0/rotation", {0, 2}, {0,    0, 0, 0,    0,    0, 0, 1,    0.5F, 0.2F, 0, 0,  //
                                                  0.3F, 0, 0, 0.4F, 0.6F, 0, 0, 0.8F, 0,    0,    0, 0},
          "VEC4", "CUBICSPLINE");
  expect_poses({0}, 3.0);
}

TEST_F(PoseTest, RotationsTakeTheShorterArcAndNeedNotBeUnit) {
  const float half = 0.70710678F;
  animate(gltf_, 0, "/nodes/0/rotation", {0, 1, 2, 3},
          {0, 0, 0, 1, 0, 0, -half, -half, 0, 0, 1.414F, 1.414F, 0, 0, 1, 1e-5F}, "VEC4");
  expect_poses({0}, 3.0);
}

TEST_F(PoseTest, NearlyEqualRotationsAreInterpolated) {
  animate(gltf_, 0, "/nodes/0/rotation", {0, 1, 2, 3}, {0, 0, 0, 1, 1e-6F, 0, 0, 1, 1e-6F, 0, 0, 1, -1e-6F, 0, 0, -1},
          "VEC4");
  expect_poses({0}, 3.0);
}

TEST_F(PoseTest, IntegersAreNormalised) {
  animate(gltf_, 0, "/nodes/0/rotation", {0, 1, 2},
          gltf_.add<int16_t>({0, 0, 0, 32767, 14893, 14893, 0, 25101, 18846, 18846, -32768, 2856}, "VEC4", true));
  animate(gltf_, 0, "/nodes/0/scale", {0, 2}, gltf_.add<uint8_t>({255, 255, 255, 51, 102, 255}, "VEC3", true));
  expect_poses({0}, 2.0);
}

TEST_F(PoseTest, AccessorsMayBeSparseOrWithoutAView) {
  const size_t values = gltf_.add<float>({0, 0, 0, 0, 0, 0, 3, 3, 3}, "VEC3");
  gltf_.json["accessors"][values]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", gltf_.add_view<uint8_t>({1})}, {"componentType", 5121}}},
      {"values", {{"bufferView", gltf_.add_view<float>({1, -2, 5})}}}};
  animate(gltf_, 0, "/nodes/0/translation", {0, 1, 2}, values);
  gltf_.json["nodes"][0]["scale"] = {3, 3, 3};
  const size_t zeros = gltf_.add<float>({0, 0, 0, 0, 0, 0}, "VEC3");
  gltf_.json["accessors"][zeros].erase("bufferView");
  gltf_.json["accessors"][zeros]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", gltf_.add_view<uint8_t>({0, 1})}, {"componentType", 5121}}},
      {"values", {{"bufferView", gltf_.add_view<float>({1, 1, 2, 2, 1, 1})}}}};
  animate(gltf_, 0, "/nodes/0/scale", {0, 2}, zeros);
  expect_poses({0}, 2.0);
}

TEST_F(PoseTest, ScaleThroughZeroHidesAndMirrors) {
  animate(gltf_, 0, "/nodes/0/scale", {0, 2}, {1, 1, 1, -1, 1, 1}, "VEC3");
  expect_poses({0}, 2.0);
  const Scene flat = scene_at(load(), {.animations = {0}, .time_s = 1.0});
  EXPECT_EQ(flat.objects[0].world_from_object, dmat4(1.0)) << "the flattened triangle has a geometry of its own";
  gltf_.json["animations"].clear();
  animate(gltf_, 0, "/nodes/0/scale", {0, 2}, {1, 1, 1, -1, -1, -1}, "VEC3");
  const Scene hidden = scene_at(load(), {.animations = {0}, .time_s = 1.0});
  ASSERT_EQ(hidden.objects.size(), 1U);
  EXPECT_EQ(hidden.objects[0].geometry, Object::kNoGeometry);
}

TEST_F(PoseTest, ObjectsHiddenAtRestMayAppear) {
  gltf_.json["nodes"][0]["scale"] = {0, 0, 0};
  animate(gltf_, 0, "/nodes/0/scale", {0, 2}, {1, 1, 1, 2, 2, 2}, "VEC3");
  const Scene scene = load();
  EXPECT_EQ(scene.objects[0].geometry, Object::kNoGeometry);
  const Scene shown = scene_at(scene, {.animations = {0}, .time_s = 1.0});
  expect_same(shown, test::pose_by_specification(gltf_, {0}, 1));
}

TEST_F(PoseTest, VisibilityIsInherited) {
  gltf_.show({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
  gltf_.add_node({{"children", {0, 1}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  animate(gltf_, 0, "/nodes/2/extensions/KHR_node_visibility/visible", {0, 1, 2},
          gltf_.add<uint8_t>({0, 1, 0}, "SCALAR"), "STEP");
  animate(gltf_, 0, "/nodes/1/extensions/KHR_node_visibility/visible", {0, 1.5F}, gltf_.add<uint8_t>({1, 0}, "SCALAR"),
          "STEP");
  expect_poses({0}, 3.0);
}

TEST_F(PoseTest, ChildrenFollowTheirParents) {
  gltf_.add_node({{"children", {0}}, {"rotation", {0, 0, 0.6, 0.8}}, {"scale", {1, 2, 1}}});
  gltf_.add_node({{"children", {1}}, {"matrix", {2, 0, 0, 0, 0, 1, 1, 0, 0, -1, 1, 0, 3, 4, 5, 1}}});
  animate(gltf_, 0, "/nodes/1/rotation", {0, 1}, {0, 0, 0, 1, 0, 0.6F, 0, 0.8F}, "VEC4");
  animate(gltf_, 0, "/nodes/0/translation", {0, 2}, {0, 0, 0, 1, 1, 1}, "VEC3");
  expect_poses({0}, 2.0);
}

TEST_F(PoseTest, NodesBelowTwoParentsMoveInBothPlaces) {
  gltf_.add_node({{"children", {0}}, {"translation", {5, 0, 0}}});
  gltf_.add_node({{"children", {0}}});
  animate(gltf_, 0, "/nodes/0/translation", {0, 2}, {0, 0, 0, 1, 1, 1}, "VEC3");
  animate(gltf_, 0, "/nodes/2/translation", {0, 2}, {0, 0, 0, 0, 7, 0}, "VEC3");
  const Scene posed = scene_at(load(), {.animations = {0}, .time_s = 1.0});
  ASSERT_EQ(posed.objects.size(), 2U);
  EXPECT_EQ(dvec3(posed.objects[0].world_from_object[3]), dvec3(5.5, 0.5, 0.5));
  EXPECT_EQ(dvec3(posed.objects[1].world_from_object[3]), dvec3(0.5, 4, 0.5));
}

/// A document whose triangle has two sets of joints.
class PosedSkinTest : public PoseTest {
 protected:
  PosedSkinTest() {
    json& attributes = gltf_.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = gltf_.add<uint8_t>({0, 1, 2, 3, 1, 0, 0, 0, 4, 1, 0, 0}, "VEC4");
    attributes["WEIGHTS_0"] = gltf_.add<uint8_t>({100, 50, 50, 25, 255, 0, 0, 0, 100, 20, 0, 0}, "VEC4", true);
    attributes["JOINTS_1"] = gltf_.add<uint16_t>({4, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0}, "VEC4");
    attributes["WEIGHTS_1"] = gltf_.add<float>({0.125F, 0, 0, 0, 0, 0, 0, 0, 0.5F, 0, 0, 0}, "VEC4");
    for (int i = 0; i < 5; ++i) gltf_.add_node({{"translation", {i, 1, 0}}});
    gltf_.json["nodes"][1]["children"] = {2, 3};
    gltf_.json["nodes"][0]["skin"] = 0;
    gltf_.json["nodes"][0]["translation"] = {100, 100, 100};
    gltf_.json["skins"] = {{{"joints", {1, 2, 3, 4, 5}}}};
    // The joints 4 and 5 belong to no scene.
    gltf_.json["scenes"] = {{{"nodes", {0, 1}}}};
    animate(gltf_, 0, "/nodes/1/rotation", {0, 2}, {0, 0, 0, 1, 0.6F, 0, 0, 0.8F}, "VEC4");
    animate(gltf_, 0, "/nodes/3/translation", {0, 2}, {0, 0, 0, 1, 2, 3}, "VEC3");
    animate(gltf_, 0, "/nodes/5/scale", {0, 2}, {1, 1, 1, 3, 0.5F, 1}, "VEC3");
  }
};

TEST_F(PosedSkinTest, JointsMoveTheMesh) {
  expect_poses({0}, 2.0);
}

TEST_F(PosedSkinTest, InverseBindMatricesComeFirst) {
  std::vector<float> matrices(80, 0.0F);
  for (size_t joint = 0; joint < 5; ++joint) {
    for (size_t axis = 0; axis < 4; ++axis) matrices[16 * joint + 5 * axis] = 1.0F;
    matrices[16 * joint + 4] = 0.25F * static_cast<float>(joint);
    matrices[16 * joint + 13] = -1.0F;
  }
  gltf_.json["skins"][0]["inverseBindMatrices"] = gltf_.add<float>(matrices, "MAT4");
  expect_poses({0}, 2.0);
}

TEST_F(PosedSkinTest, MorphTargetsComeBeforeTheSkin) {
  gltf_.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", gltf_.add<float>({0, 0, 1, 0, 1, 0, 1, 0, 0}, "VEC3")}},
      {{"POSITION", gltf_.add<int8_t>({0, 0, 1, 0, 2, 0, 0, 0, -3}, "VEC3")}}};
  gltf_.json["meshes"][0]["weights"] = {0.25, 0.5};
  animate(gltf_, 0, "/nodes/0/weights", {0, 1, 2}, {0, 1, 1, 0, -0.5F, 2}, "SCALAR");
  expect_poses({0}, 2.0);
}

TEST_F(PoseTest, MorphTargetsMoveVertices) {
  json& primitive = gltf_.json["meshes"][0]["primitives"][0];
  const size_t zeros = gltf_.add<float>({0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  gltf_.json["accessors"][zeros].erase("bufferView");
  gltf_.json["accessors"][zeros]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", gltf_.add_view<uint16_t>({2})}, {"componentType", 5123}}},
      {"values", {{"bufferView", gltf_.add_view<float>({1, 2, 3})}}}};
  primitive["targets"] = {{{"POSITION", zeros}}, {{"POSITION", gltf_.add<float>({0, 0, 1, 0, 1, 0, 1, 0, 0}, "VEC3")}}};
  animate(gltf_, 0, "/nodes/0/weights", {0, 1, 2},
          {0, 0, 0.5F, 0, 1, 0,  //
           0, 1, 1, 0, 0, 0,     //
           1, 1, 0.25F, 0.5F, 0, 0},
          "SCALAR", "CUBICSPLINE");
  expect_poses({0}, 2.0);
  gltf_.json["animations"].clear();
  animate(gltf_, 0, "/meshes/0/weights", {0, 1}, {0, 0.5F, 1, -1}, "SCALAR");
  animate(gltf_, 1, "/nodes/0/weights/1", {0, 1}, {0, 2}, "SCALAR");
  expect_poses({0}, 2.0);
  expect_poses({1}, 2.0);
}

TEST_F(PoseTest, SeveralAnimationsAreShownTogether) {
  animate(gltf_, 0, "/nodes/0/translation", {0, 2}, {0, 0, 0, 1, 2, 3}, "VEC3");
  animate(gltf_, 1, "/nodes/0/rotation", {0, 1}, {0, 0, 0, 1, 0.6F, 0, 0, 0.8F}, "VEC4");
  animate(gltf_, 1, "/nodes/0/translation", {0, 1}, {9, 9, 9, 9, 9, 9}, "VEC3");
  expect_poses({0, 1}, 2.0);
  const Scene scene = load();
  const Scene both = scene_at(scene, {.animations = {1, 0}, .time_s = 1.0});
  EXPECT_THAT(both.warnings,
              testing::ElementsAre("animation 1 changes what animation 0 changes too; the latter counts there"));
}

TEST_F(PoseTest, LoopsStartAgain) {
  animate(gltf_, 0, "/nodes/0/translation", {0, 2}, {0, 0, 0, 2, 0, 0}, "VEC3");
  const Scene scene = load();
  const auto place_at = [&](double time_s, bool loops) {
    return scene_at(scene, {.animations = {0}, .time_s = time_s, .loops = loops}).objects[0].world_from_object[3].x;
  };
  EXPECT_EQ(place_at(5.5, true), 1.5);
  EXPECT_EQ(place_at(2.0, true), 0.0);
  EXPECT_EQ(place_at(5.5, false), 2.0);
  EXPECT_EQ(place_at(-0.5, true), 1.5);
}

TEST_F(PoseTest, AnEarlierPoseHasNoEffect) {
  animate(gltf_, 0, "/nodes/0/scale", {0, 2}, {1, 1, 1, -1, 1, 1}, "VEC3");
  gltf_.json["materials"] = {{{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}}}};
  gltf_.json["meshes"][0]["primitives"][0]["material"] = 0;
  animate(gltf_, 0, "/materials/0/pbrMetallicRoughness/roughnessFactor", {0, 2}, {0, 1}, "SCALAR");
  const Scene scene = load();
  const Scene flat = scene_at(scene, {.animations = {0}, .time_s = 1.0});
  EXPECT_EQ(flat.geometries.size(), 2U);
  const Scene again = scene_at(scene_at(flat, {.animations = {0}, .time_s = 0.5}), {});
  EXPECT_EQ(again.geometries.size(), 1U);
  EXPECT_EQ(again.objects[0].geometry, scene.objects[0].geometry);
  EXPECT_EQ(again.objects[0].world_from_object, scene.objects[0].world_from_object);
  EXPECT_EQ(std::get<MetallicRoughness>(again.materials[0].model).roughness, 0.5F);
}

TEST_F(PoseTest, FarScenesMoveAroundTheirCenter) {
  gltf_.json["nodes"][0]["translation"] = {1e9, 0, 0};
  animate(gltf_, 0, "/nodes/0/translation", {0, 1}, gltf_.add<float>({1e9F, 0, 0, 1e9F, 4, 0}, "VEC3"));
  const Scene scene = load();
  EXPECT_NE(scene.center.x, 0.0);
  const Scene posed = scene_at(scene, {.animations = {0}, .time_s = 0.5});
  EXPECT_EQ(posed.objects[0].world_from_object[3].x, scene.objects[0].world_from_object[3].x);
  EXPECT_EQ(posed.objects[0].world_from_object[3].y, scene.objects[0].world_from_object[3].y + 2.0);
}

TEST_F(PoseTest, ObjectsWithoutLinksRest) {
  animate(gltf_, 0, "/nodes/0/translation", {0, 2}, {0, 0, 0, 2, 0, 0}, "VEC3");
  Scene scene = load();
  scene.add("own", Sphere{dvec3(0.0), 1.0}, 0, dmat4(2.0));
  const Scene posed = scene_at(scene, {.animations = {0}, .time_s = 1.0});
  EXPECT_EQ(posed.objects[1].world_from_object, dmat4(2.0));
  EXPECT_TRUE(std::holds_alternative<Sphere>(posed.geometries[posed.objects[1].geometry]));
}

TEST_F(PoseTest, ShapesThatAreDistortedFallBackToTheirMesh) {
  gltf_.json["extensions"]["KHR_implicit_shapes"]["shapes"] = {{{"type", "sphere"}}};
  gltf_.json["meshes"][0]["primitives"][0]["extensions"]["PROMIN_mesh_primitive_implicit_shape"]["shape"] = 0;
  animate(gltf_, 0, "/nodes/0/scale", {0, 2}, {1, 1, 1, 1, 3, 1}, "VEC3");
  const Scene scene = load();
  ASSERT_TRUE(std::holds_alternative<Sphere>(scene.geometries[scene.objects[0].geometry]));
  const Scene posed = scene_at(scene, {.animations = {0}, .time_s = 1.0});
  EXPECT_TRUE(std::holds_alternative<Mesh>(posed.geometries[posed.objects[0].geometry]));
  EXPECT_THAT(posed.warnings, testing::Contains(testing::HasSubstr("distorts an analytic shape")));
  EXPECT_TRUE(validate(posed).empty());
}

}  // namespace
}  // namespace promin
