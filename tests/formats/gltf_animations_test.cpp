// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <limits>

#include "promin/motion.h"
#include "support/moving_gltf.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using nlohmann::json;
using test::animate;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class GltfAnimationTest : public SceneFolder {
 protected:
  Scene load(bool is_strict = false) { return load_scene(write("scene.gltf", gltf_.text()), {.is_strict = is_strict}); }
  void move(const std::vector<float>& times, const std::vector<float>& values, const std::string& type = "VEC3") {
    animate(gltf_, 0, type == "VEC4" ? "/nodes/0/rotation" : "/nodes/0/translation", times, values, type);
  }
  json& channel() { return gltf_.json["animations"][0]["channels"][0]; }
  json& sampler() { return gltf_.json["animations"][0]["samplers"][0]; }

  /// Expects that nothing moves, and that there is one warning, which a strict loader turns into a refusal.
  void expect_rest(const char* warning, const char* code) {
    const Scene scene = load();
    ASSERT_THAT(scene.motion->animations, SizeIs(1));
    EXPECT_THAT(scene.motion->animations[0].channels, IsEmpty());
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr(warning)));
    EXPECT_EQ(scene_at(scene, {.animations = {0}, .time_s = 1.0}).objects[0].world_from_object, dmat4(1.0));
    EXPECT_THAT(message_of([&] { load(true); }), HasProblem(code));
  }

  GltfBuilder gltf_ = triangle_gltf();
};

TEST_F(GltfAnimationTest, AreDescribed) {
  move({0.5F, 2}, {0, 0, 0, 1, 2, 3});
  move({1, 3}, {0, 0, 0, 1, 0, 0, 0, 1}, "VEC4");
  gltf_.json["animations"][0]["name"] = "Walk";
  gltf_.json["nodes"][0]["name"] = "Legs";
  const Scene scene = load();
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.motion->animations, SizeIs(1));
  const Animation& animation = scene.motion->animations[0];
  EXPECT_EQ(animation.name, "Walk");
  EXPECT_EQ(animation.duration_s, 3.0);
  ASSERT_THAT(animation.channels, SizeIs(2));
  EXPECT_EQ(animation.channels[1].property, AnimatedProperty::kRotation);
  EXPECT_THAT(animation.samplers[0].times, ElementsAre(0.5, 2.0));
  EXPECT_THAT(animation.samplers[0].values, ElementsAre(0, 0, 0, 1, 2, 3));
  ASSERT_THAT(scene.motion->nodes, SizeIs(1));
  EXPECT_EQ(scene.motion->nodes[0].name, "Legs");
}

TEST_F(GltfAnimationTest, KeysThatAreNotInOrderStandStill) {
  move({0, 1, 1, 2}, {0, 0, 0, 1, 0, 0, 8, 0, 0, 9, 0, 0});
  expect_rest(
      "animations[0].samplers[0].input: the keys of an animation are not in the order of time (key 2); what it changes "
      "stands still",
      "gltf.animation.order");
}

TEST_F(GltfAnimationTest, TimesThatAreNoNumbersStandStill) {
  move({0, kNaN}, {0, 0, 0, 1, 0, 0});
  expect_rest("the times of an animation are missing, negative or not finite", "gltf.animation.times");
}

TEST_F(GltfAnimationTest, NegativeTimesStandStill) {
  move({-1, 1}, {0, 0, 0, 1, 0, 0});
  expect_rest("the times of an animation are missing, negative or not finite", "gltf.animation.times");
}

TEST_F(GltfAnimationTest, TimesThatAreNoFloatsStandStill) {
  move({0, 1}, {0, 0, 0, 1, 0, 0});
  sampler()["input"] = gltf_.add<uint8_t>({0, 1}, "SCALAR");
  expect_rest("the times of an animation are not floats", "gltf.animation.format");
}

TEST_F(GltfAnimationTest, ValuesOfAnotherKindStandStill) {
  move({0, 1}, {0, 0, 0, 1, 0, 0});
  sampler()["output"] = gltf_.add<float>({0, 1, 2, 3}, "VEC2");
  expect_rest("the values of an animation have the wrong number of components", "gltf.animation.format");
}

TEST_F(GltfAnimationTest, ValuesThatAreNotFiniteStandStill) {
  move({0, 1}, {0, 0, 0, 1, kNaN, 0});
  expect_rest("a value of an animation is not finite", "gltf.animation.values");
}

TEST_F(GltfAnimationTest, RotationsOfLengthZeroStandStill) {
  move({0, 1}, {0, 0, 0, 0, 0, 0, 0, 1}, "VEC4");
  expect_rest(
      "animations[0].samplers[0].output: a rotation of an animation has length 0 (key 0); what it changes "
      "stands still",
      "gltf.rotation.zero");
}

TEST_F(GltfAnimationTest, TangentsOfSplinesMayHaveLengthZero) {
  animate(gltf_, 0, "/nodes/0/rotation", {0, 1},
          {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4", "CUBICSPLINE");
  EXPECT_THAT(load().warnings, IsEmpty());
}

TEST_F(GltfAnimationTest, UnknownTargetsStandStill) {
  move({0, 1}, {0, 0, 0, 1, 0, 0});
  channel()["target"]["path"] = "colour";
  expect_rest("the path of an animation's target is unknown (\"colour\")", "gltf.animation.target");
  channel()["target"] = {{"path", "weights"}, {"node", 0}};
  expect_rest("an animation changes weights of morph targets that do not exist", "gltf.animation.target");
  channel()["sampler"] = 7;
  channel()["target"] = {{"path", "scale"}, {"node", 0}};
  expect_rest("a sampler does not exist", "gltf.animation.sampler");
}

TEST_F(GltfAnimationTest, PointersToNothingStandStill) {
  move({0, 1}, {0, 0, 0, 1, 0, 0});
  const auto point = [&](const std::string& pointer) {
    channel()["target"] = {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
  };
  point("/nodes/1/translation");
  expect_rest("an animation's target does not exist (\"/nodes/1/translation\")", "gltf.animation.target");
  point("/materials/0/emissiveFactor");
  expect_rest("an animation's target does not exist", "gltf.animation.target");
  for (const char* unknown :
       {"/nodes/0/rotation/x", "/materials/0/normalTexture/extensions/KHR_texture_transform/texCoord", "/nodes//scale",
        "/nodes/0", "", "/extras/a", "/nodes/99999999999999999999/scale"}) {
    point(unknown);
    const Scene scene = load();
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("an animation changes a property that promin does not animate")));
    EXPECT_THAT(scene.motion->animations[0].channels, IsEmpty());
  }
}

TEST_F(GltfAnimationTest, ChannelsWithoutANodeAreIgnored) {
  move({0, 1}, {0, 0, 0, 1, 0, 0});
  channel()["target"].erase("node");
  EXPECT_THAT(load().warnings, IsEmpty());
}

TEST_F(GltfAnimationTest, NodesWithAMatrixStandStill) {
  gltf_.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  move({0, 1}, {0, 0, 0, 1, 0, 0});
  expect_rest("an animation moves a node that has a matrix", "gltf.animation.matrix");
}

TEST_F(GltfAnimationTest, OfTwoChannelsTheFirstCounts) {
  move({0, 1}, {0, 0, 0, 1, 0, 0});
  move({0, 1}, {0, 0, 0, 5, 0, 0});
  const Scene scene = load();
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("two channels of an animation change the same property")));
  EXPECT_EQ(scene_at(scene, {.animations = {0}, .time_s = 1.0}).objects[0].world_from_object[3].x, 1.0);
}

TEST_F(GltfAnimationTest, WrongCountsOfValuesAreRefusedWhenTheyAreShown) {
  for (const size_t count : {1U, 3U}) {
    gltf_.json.erase("animations");
    move({0, 1}, std::vector<float>(3 * count));
    const Scene scene = load();
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("but its keys need 2")));
    EXPECT_EQ(scene_at(scene, {}).objects.size(), 1U) << "the pose of the nodes needs no animation";
    EXPECT_THAT(message_of([&] { scene_at(scene, {.animations = {0}}); }), HasProblem("gltf.animation.count"));
    EXPECT_THAT(message_of([&] { load(true); }), HasProblem("gltf.animation.count"));
  }
}

TEST_F(GltfAnimationTest, VisibilityIsNotInterpolated) {
  animate(gltf_, 0, "/nodes/0/extensions/KHR_node_visibility/visible", {0, 1}, gltf_.add<uint8_t>({1, 0}, "SCALAR"));
  const Scene scene = load();
  EXPECT_THAT(scene.warnings,
              ElementsAre(HasSubstr("an animation interpolates a visibility; promin reads it as STEP")));
  EXPECT_NE(scene_at(scene, {.animations = {0}, .time_s = 0.9}).objects[0].geometry, Object::kNoGeometry);
  EXPECT_EQ(scene_at(scene, {.animations = {0}, .time_s = 1.0}).objects[0].geometry, Object::kNoGeometry);
}

TEST_F(GltfAnimationTest, MissingFilesOfAnimationsStandStill) {
  move({0, 1}, {0, 0, 0, 1, 0, 0});
  gltf_.text();
  gltf_.json["buffers"].push_back({{"byteLength", 24}, {"uri", "moves.bin"}});
  gltf_.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 24}});
  const size_t output = sampler()["output"];
  gltf_.json["accessors"][output]["bufferView"] = gltf_.json["bufferViews"].size() - 1;
  const Scene scene = load_scene(write("scene.gltf", gltf_.json.dump()));
  EXPECT_THAT(scene.warnings,
              ElementsAre(HasSubstr("a buffer of images or animations cannot be read"),
                          HasSubstr("the numbers of an animation are missing; what it changes stands still")));
  EXPECT_THAT(scene.motion->animations[0].channels, IsEmpty());
}

TEST_F(GltfAnimationTest, FaultyMembersAreLeftOut) {
  move({0, 1}, {0, 0, 0, 1, 0, 0});
  const json good = gltf_.json;
  for (const auto& [pointer, value] :
       {std::pair("/animations/0/samplers/0/input", json(99)), std::pair("/animations/0/samplers/0/output", json("x")),
        std::pair("/animations/0/channels/0/target/node", json(7)),
        std::pair("/animations/0/channels/0/target", json(7)), std::pair("/animations/0/channels", json(7)),
        std::pair("/animations/0", json(7))}) {
    gltf_.json = good;
    gltf_.json[json::json_pointer(pointer)] = value;
    const Scene scene = load();
    EXPECT_FALSE(scene.warnings.empty()) << pointer;
    ASSERT_THAT(scene.motion->animations, SizeIs(1)) << pointer;
    EXPECT_THAT(scene.motion->animations[0].channels, IsEmpty()) << pointer;
  }
}

TEST_F(GltfAnimationTest, MorphTargetsThatDoNotFitAreIgnored) {
  json& primitive = gltf_.json["meshes"][0]["primitives"][0];
  primitive["targets"] = {{{"POSITION", gltf_.add<float>({1, 1, 1}, "VEC3")}},
                          {{"POSITION", gltf_.add<float>({1, 1, 1, kNaN, 1, 1, 1, 1, 1}, "VEC3")}}};
  gltf_.json["meshes"][0]["weights"] = {1, 1};
  const Scene scene = load();
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("a morph target has a different number of vertices than its mesh"),
                                          HasSubstr("a morph target has numbers that are missing or not finite")));
}

}  // namespace
}  // namespace promin
