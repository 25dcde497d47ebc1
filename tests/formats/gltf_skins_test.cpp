// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "support/expect_near.h"
#include "support/gltf_builder.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using nlohmann::json;
using test::expect_near;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

void expect_all_near(const std::vector<vec3>& got, const std::vector<vec3>& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (size_t i = 0; i < got.size(); ++i) expect_near(got[i], wanted[i]);
}

/// A triangle that node 0 shows with a skin of the joints 1 and 2.
class GltfSkinTest : public SceneFolder {
 protected:
  GltfSkinTest() {
    primitive()["attributes"]["JOINTS_0"] = gltf_.add<uint8_t>({0, 1, 9, 9, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
    primitive()["attributes"]["WEIGHTS_0"] = gltf_.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}, "VEC4");
    gltf_.add_node({{"translation", {0, 0, 2}}});
    gltf_.add_node({{"translation", {0, 4, 0}}, {"scale", {3, 3, 3}}});
    gltf_.json["nodes"][0]["skin"] = 0;
    gltf_.json["skins"] = {{{"joints", {1, 2}}}};
  }

  json& primitive() { return gltf_.json["meshes"][0]["primitives"][0]; }
  LoadedScene load() { return SceneFolder::load("scene.gltf", gltf_.text()); }
  std::string refusal() { return SceneFolder::refusal("scene.gltf", gltf_.text()); }
  std::vector<vec3> corners() { return corners_of(mesh_of(load())); }

  GltfBuilder gltf_ = triangle_gltf();
};

/// The first vertex follows joint 1, the second follows joint 2, the third follows both.
const std::vector<vec3> kPosed = {{0, 0, 2}, {3, 4, 0}, {0, 4, 1}};

TEST_F(GltfSkinTest, JointsPoseTheMeshAndItsOwnNodeDoesNot) {
  expect_all_near(corners(), kPosed);
  EXPECT_THAT(load().warnings, IsEmpty());
  gltf_.json["nodes"][0]["translation"] = {7, 8, 9};
  gltf_.add_node({{"children", {0}}, {"scale", {5, 5, 5}}});
  expect_all_near(corners(), kPosed);
  gltf_.json["nodes"][0]["scale"] = {0, 0, 0};
  expect_all_near(corners(), kPosed);
}

TEST_F(GltfSkinTest, InverseBindMatricesComeFirst) {
  std::vector<float> matrices(32, 0.0F);
  for (size_t i = 0; i < 2; ++i) {
    for (size_t axis = 0; axis < 4; ++axis) matrices[16 * i + 5 * axis] = 1.0F;
    matrices[16 * i + 12] = -1.0F;
  }
  gltf_.json["skins"][0]["inverseBindMatrices"] = gltf_.add<float>(matrices, "MAT4");
  expect_all_near(corners(), {{-1, 0, 2}, {0, 4, 0}, {-2, 4, 1}});
  gltf_.json["skins"][0]["inverseBindMatrices"] =
      gltf_.add<float>(std::vector<float>(matrices.begin(), matrices.begin() + 16), "MAT4");
  EXPECT_THAT(refusal(), HasProblem("gltf.skin.count 1 2"));
}

TEST_F(GltfSkinTest, LastRowsOfInverseBindMatricesAreMadeAffine) {
  std::vector<float> matrices(32, 0.0F);
  for (size_t i = 0; i < 8; ++i) matrices[16 * (i / 4) + 5 * (i % 4)] = 1.0F;
  matrices[3] = 5e-4F;
  gltf_.json["skins"][0]["inverseBindMatrices"] = gltf_.add<float>(matrices, "MAT4");
  expect_all_near(corners(), kPosed);
  EXPECT_THAT(load().warnings, IsEmpty()) << "rounding";
  matrices[31] = 0.5F;
  gltf_.json["skins"][0]["inverseBindMatrices"] = gltf_.add<float>(matrices, "MAT4");
  const LoadedScene scene = load();
  expect_all_near(corners_of(mesh_of(scene)), kPosed);
  EXPECT_THAT(scene.warnings, ElementsAre("skins[0].inverseBindMatrices, element 1: an inverse bind matrix is not "
                                          "affine (0.500000); its last row is read as 0 0 0 1"));
}

TEST_F(GltfSkinTest, JointsMayBeInNoScene) {
  gltf_.json["scenes"] = {{{"nodes", {0}}}};
  expect_all_near(corners(), kPosed);
  gltf_.add_node({{"children", {1, 2}}, {"translation", {10, 0, 0}}});
  expect_all_near(corners(), {{10, 0, 2}, {13, 4, 0}, {10, 4, 1}});
}

TEST_F(GltfSkinTest, EverySetOfJointsCounts) {
  primitive()["attributes"]["JOINTS_1"] = gltf_.add<uint16_t>(std::vector<uint16_t>(12, 1), "VEC4");
  primitive()["attributes"]["WEIGHTS_1"] = gltf_.add<uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 255, 0, 0, 0}, "VEC4", true);
  // The third vertex has 1/2 of joint 1 and 3/2 of joint 2; the sum of the weights is 2.
  expect_all_near(corners(), {kPosed[0], kPosed[1], {0, 0.25F + 0.75F * 7, 0.5F}});
}

TEST_F(GltfSkinTest, MorphTargetsMoveFirst) {
  primitive()["targets"] = {{{"POSITION", gltf_.add<float>({0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3")}}};
  gltf_.json["nodes"][0]["weights"] = {1};
  EXPECT_EQ(corners()[1], vec3(6, 4, 0));
}

TEST_F(GltfSkinTest, NormalsAndTangentsFollow) {
  const float half = 0.70710678F;
  primitive()["attributes"]["NORMAL"] = gltf_.add<float>({half, half, 0, half, half, 0, half, half, 0}, "VEC3");
  primitive()["attributes"]["TANGENT"] =
      gltf_.add<float>({half, -half, 0, 1, half, -half, 0, 1, half, -half, 0, -1}, "VEC4");
  primitive()["attributes"]["TEXCOORD_0"] = gltf_.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  gltf_.json["nodes"][2]["scale"] = {3, 1, 1};
  const LoadedScene scene = load();
  const Mesh& mesh = mesh_of(scene);
  // Under a scale of (3, 1, 1) normals are multiplied by (1/3, 1, 1); under the mean scale of (2, 1, 1) by (1/2, 1, 1).
  expect_all_near(mesh.normals, {{half, half, 0}, glm::normalize(vec3(1, 3, 0)), glm::normalize(vec3(1, 2, 0))});
  std::vector<vec3> tangents;
  for (const vec4& tangent : mesh.tangents) tangents.emplace_back(tangent);
  expect_all_near(tangents, {{half, -half, 0}, glm::normalize(vec3(3, -1, 0)), glm::normalize(vec3(2, -1, 0))});
  EXPECT_EQ(mesh.tangents[2].w, -1.0F);
}

TEST_F(GltfSkinTest, JointsThatMirrorTurnTheWinding) {
  primitive()["attributes"]["NORMAL"] = gltf_.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  gltf_.add_node({{"children", {1, 2}}, {"scale", {1, 1, -1}}});
  const LoadedScene scene = load();
  const Mesh& mesh = mesh_of(scene);
  EXPECT_TRUE(scene.objects.at(0).is_rewound) << "as hits number its corners";
  // The mesh behaves like one whose node mirrors it: the order of the corners is reversed, and the normals turn with
  // the surface.
  expect_all_near(corners_of(mesh), {{0, 0, -2}, {0, 4, -1}, {3, 4, 0}});
  for (const vec3& normal : mesh.normals) EXPECT_EQ(normal, vec3(0, 0, -1));
}

TEST_F(GltfSkinTest, NodesShareWhatTheySkinAlike) {
  gltf_.add_node({{"mesh", 0}, {"skin", 0}});
  gltf_.add_node({{"mesh", 0}, {"translation", {1, 0, 0}}});
  write("scene.gltf", gltf_.text());
  const Scene scene = load_scene(folder_ / "scene.gltf");
  ASSERT_THAT(scene.objects, SizeIs(3));
  EXPECT_EQ(scene.objects[1].geometry, scene.objects[0].geometry);
  EXPECT_NE(scene.objects[2].geometry, scene.objects[0].geometry);
  EXPECT_EQ(scene.objects[2].world_from_object[3].x, 1.0) << "without a skin the node counts";
}

TEST_F(GltfSkinTest, JointsOfScaleZeroHide) {
  gltf_.add_node({{"children", {1, 2}}, {"scale", {0, 0, 0}}});
  gltf_.show({{"attributes", {{"POSITION", 0}}}});
  write("scene.gltf", gltf_.text());
  const Scene scene = load_scene(folder_ / "scene.gltf");
  ASSERT_THAT(scene.objects, SizeIs(2));
  EXPECT_EQ(scene.objects[0].geometry, Object::kNoGeometry);
  EXPECT_NE(scene.objects[1].geometry, Object::kNoGeometry);
}

TEST_F(GltfSkinTest, BadWeightsAreRepaired) {
  for (const float bad : {0.0F, std::numeric_limits<float>::quiet_NaN()}) {
    primitive()["attributes"]["WEIGHTS_0"] = gltf_.add<float>({bad, 0, 0, 0, bad, 0, 0, 0, 0.25F, 0.25F, 0, 0}, "VEC4");
    const LoadedScene scene = load();
    expect_all_near(corners_of(mesh_of(scene)), kPosed);
    EXPECT_THAT(scene.warnings,
                ElementsAre(HasSubstr(
                    "meshes[0].primitives[0].attributes.WEIGHTS_0, element 0: a vertex of a skinned mesh has no "
                    "weights, or weights that are not numbers, and 1 more; it follows the first of its joints")));
  }
}

TEST_F(GltfSkinTest, WithoutJointsAMeshStandsAsItIs) {
  primitive()["attributes"].erase("JOINTS_0");
  const LoadedScene bare = load();
  EXPECT_EQ(corners_of(mesh_of(bare))[1], vec3(1, 0, 0));
  EXPECT_THAT(bare.warnings, ElementsAre(HasSubstr("has no joints and weights")));
  gltf_.json["skins"][0]["joints"] = json::array();
  gltf_.json["nodes"][0]["translation"] = {7, 0, 0};
  const LoadedScene unskinned = load();
  EXPECT_EQ(corners_of(mesh_of(unskinned))[1], vec3(8, 0, 0));
  EXPECT_THAT(unskinned.warnings, ElementsAre("skins[0]: a skin has no joints; its meshes are placed by their nodes"));
}

TEST_F(GltfSkinTest, IndicesThatLeadNowhereAreRefused) {
  primitive()["attributes"]["JOINTS_0"] = gltf_.add<uint8_t>({0, 1, 9, 9, 2, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
  EXPECT_THAT(refusal(), HasSubstr("joint 2 is out of range, because the skin has only 2 joints"));
  gltf_.json["skins"][0]["joints"] = {1, 77};
  EXPECT_THAT(refusal(), HasSubstr("skins[0].joints[1]"));
  gltf_.json["skins"][0]["joints"] = {1, 2};
  gltf_.json["nodes"][0]["skin"] = 3;
  EXPECT_THAT(refusal(), HasSubstr("nodes[0].skin"));
}

}  // namespace
}  // namespace promin
