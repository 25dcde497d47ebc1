// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "motion/angles.h"
#include "motion/sampler.h"
#include "promin/motion.h"
#include "promin/validate.h"
#include "support/expect_near.h"
#include "support/moving_gltf.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using nlohmann::json;
using test::animate;
using test::expect_near;
using testing::HasSubstr;

TEST(AnglesTest, AreAsAccurateAsTheLibrary) {
  for (int i = 0; i <= 1000; ++i) {
    const double angle = std::numbers::pi / 2.0 * i / 1000.0;
    EXPECT_NEAR(sine(angle), std::sin(angle), 4e-16);
    EXPECT_NEAR(angle_of_sine(std::sin(angle / 2.0)), angle / 2.0, 4e-16);
  }
}

TEST(AnglesTest, AnyAngleHasASine) {
  for (int i = -1000; i <= 1000; ++i) EXPECT_NEAR(sine_of_any(0.02 * i), std::sin(0.02 * i), 4e-15);
}

TEST(SlerpTest, TurnsAtAConstantSpeed) {
  const dvec4 from(0, 0, 0, 1);
  const dvec4 to(0, std::sin(0.7), 0, std::cos(0.7));
  for (const double t : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    const dvec4 between = slerp(from, to, t);
    EXPECT_NEAR(between.y, std::sin(0.7 * t), 1e-15);
    EXPECT_NEAR(slerp(from, -to, t).y, std::sin(0.7 * t), 1e-15) << "q and -q are the same rotation";
  }
  EXPECT_NEAR(glm::length(slerp(from, -from, 0.5)), 1.0, 1e-15);
}

TEST(SamplerTest, SplinesOfRotationsAreUnitQuaternions) {
  const AnimationSampler sampler{
      Interpolation::kCubicSpline, {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}};
  std::array<double, 4> q{};
  sample(sampler, 0.5, true, q);
  EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 1e-15);
  EXPECT_GT(q[0], 0.1);
}

class SceneAtTest : public SceneFolder {
 protected:
  Scene load() { return load_scene(write("scene.gltf", gltf_.text())); }
  Scene at(double time_s) { return scene_at(load(), {.animations = {0}, .time_s = time_s}); }
  static const Mesh& mesh_of(const Scene& scene) { return std::get<Mesh>(scene.geometries[scene.objects[0].geometry]); }

  GltfBuilder gltf_ = triangle_gltf();
};

TEST_F(SceneAtTest, MorphTargetsMoveEveryAttribute) {
  json& primitive = gltf_.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = gltf_.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  primitive["attributes"]["TANGENT"] = gltf_.add<float>({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}, "VEC4");
  primitive["attributes"]["TEXCOORD_0"] = gltf_.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  primitive["attributes"]["TEXCOORD_1"] = gltf_.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  primitive["attributes"]["COLOR_0"] = gltf_.add<float>({1, 0, 0, 1, 0, 1, 0, 0.75F, 0, 0, 1, 1}, "VEC4");
  primitive["targets"] = {{{"NORMAL", gltf_.add<float>({1, 0, 0, 0, 0, 0, 0, 0, -1}, "VEC3")},
                           {"TANGENT", gltf_.add<float>({0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC3")},
                           {"TEXCOORD_0", gltf_.add<float>({2, 0, 0, 0, 0, 0}, "VEC2")},
                           {"TEXCOORD_1", gltf_.add<float>({0, 0, 0, 4, 0, 0}, "VEC2")},
                           {"COLOR_0", gltf_.add<float>({-4, 0.5F, 0, 0, 0, 0, 0, 4, 0, 0, 0, -0.5F}, "VEC4")}}};
  animate(gltf_, 0, "/nodes/0/weights", {0, 1}, {0, 1}, "SCALAR");
  const Scene half = at(0.5);
  const Mesh& mesh = mesh_of(half);
  EXPECT_EQ(mesh.normals[0], vec3(0.5F, 0, 1));
  EXPECT_EQ(mesh.normals[2], vec3(0, 0, 0.5F));
  EXPECT_EQ(mesh.tangents[0], vec4(1, 0.5F, 0, -1));
  EXPECT_EQ(mesh.uvs[0], vec4(1, 0, 0, 0));
  EXPECT_EQ(mesh.uvs[1], vec4(1, 0, 1, 2));
  EXPECT_EQ(mesh.colors[0], vec4(0, 0.25F, 0, 1)) << "no colour is negative";
  EXPECT_EQ(mesh.colors[1], vec4(0, 1, 0, 1)) << "alpha is at most 1";
  EXPECT_EQ(mesh.colors[2], vec4(0, 0, 1, 0.75F));
  const Scene whole = at(1.0);
  EXPECT_TRUE(mesh_of(whole).normals.empty()) << "a normal of length 0 makes the mesh flat";
  EXPECT_TRUE(validate(whole).empty());
}

TEST_F(SceneAtTest, ColorsOfThreeComponentsMove) {
  json& primitive = gltf_.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["COLOR_0"] = gltf_.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  primitive["targets"] = {{{"COLOR_0", gltf_.add<float>({0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC3")}}};
  animate(gltf_, 0, "/nodes/0/weights", {0, 1}, {0, 1}, "SCALAR");
  EXPECT_EQ(mesh_of(at(0.5)).colors[0], vec4(1, 0.5F, 0, 1));
}

TEST_F(SceneAtTest, LightsAndCamerasFollowTheirNodes) {
  gltf_.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}}}}};
  gltf_.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}}};
  gltf_.add_node({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  gltf_.add_node({{"children", {1}}});
  animate(gltf_, 0, "/nodes/2/translation", {0, 2}, {0, 0, 0, 2, 4, 6}, "VEC3");
  const float half = 0.70710678F;
  animate(gltf_, 0, "/nodes/1/rotation", {0, 2}, {0, 0, 0, 1, 0, half, 0, half}, "VEC4");
  const Scene scene = at(2.0);
  ASSERT_EQ(scene.cameras.size(), 1U);
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.cameras[0].eye, vec3(2, 4, 6));
  expect_near(scene.cameras[0].look, vec3(-1, 0, 0));
  EXPECT_EQ(scene.lights[0].position, vec3(2, 4, 6));
  expect_near(scene.lights[0].direction, vec3(-1, 0, 0));
  EXPECT_EQ(scene_at(scene, {}).cameras[0].eye, vec3(0));
}

TEST_F(SceneAtTest, NodesOfScaleZeroKeepTheirDirection) {
  gltf_.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}}}}};
  gltf_.add_node({{"camera", 0}});
  const float half = 0.70710678F;
  animate(gltf_, 0, "/nodes/1/scale", {0, 1}, {0, 0, 0, 0, 0, 0}, "VEC3");
  animate(gltf_, 0, "/nodes/1/rotation", {0, 1}, {0, 0, 0, 1, 0, half, 0, half}, "VEC4");
  expect_near(at(1.0).cameras[0].look, vec3(-1, 0, 0));
}

TEST_F(SceneAtTest, PointersChangeLights) {
  gltf_.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}}, {{"type", "spot"}, {"color", {1, 0.5, 0}}, {"intensity", 2}}};
  gltf_.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  gltf_.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  gltf_.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const std::string light = "/extensions/KHR_lights_punctual/lights/1/";
  animate(gltf_, 0, light + "color", {0, 1}, {1, 1, 1, 0, 0, 1}, "VEC3");
  animate(gltf_, 0, light + "intensity", {0, 1}, {4, 8}, "SCALAR");
  animate(gltf_, 0, light + "range", {0, 1}, {4, 8}, "SCALAR");
  animate(gltf_, 0, light + "spot/innerConeAngle", {0, 1}, {0.1F, 0.2F}, "SCALAR");
  animate(gltf_, 0, light + "spot/outerConeAngle", {0, 1}, {0.5F, 0.7F}, "SCALAR");
  const Scene scene = load();
  const Scene posed = at(0.5);
  ASSERT_EQ(posed.lights.size(), 3U);
  for (const size_t i : {0U, 1U}) {
    EXPECT_EQ(posed.lights[i].diffuse, vec3(3, 3, 6));
    EXPECT_EQ(posed.lights[i].specular, vec3(3, 3, 6));
    EXPECT_EQ(posed.lights[i].range, 6.0F);
    EXPECT_NEAR(posed.lights[i].inner_cone_angle, 0.15F, 1e-6F);
    EXPECT_NEAR(posed.lights[i].outer_cone_angle, 0.6F, 1e-6F);
  }
  EXPECT_EQ(posed.lights[2].diffuse, vec3(1));
  EXPECT_EQ(scene.lights[0].diffuse, vec3(2, 1, 0)) << "the pose of the nodes";
  EXPECT_EQ(scene_at(posed, {}).lights[0].diffuse, vec3(2, 1, 0));
}

TEST_F(SceneAtTest, HiddenLightsKeepTheirNumbers) {
  gltf_.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  gltf_.add_node({{"extensions",
                   {{"KHR_lights_punctual", {{"light", 0}}},  //
                    {"KHR_node_visibility", {{"visible", false}}}}}});
  gltf_.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  animate(gltf_, 0, "/nodes/1/extensions/KHR_node_visibility/visible", {0, 1}, gltf_.add<uint8_t>({0, 1}, "SCALAR"),
          "STEP");
  const Scene scene = load();
  ASSERT_EQ(scene.lights.size(), 2U);
  EXPECT_FALSE(scene.lights[0].is_on);
  EXPECT_TRUE(at(1.0).lights[0].is_on);
  EXPECT_FALSE(at(0.5).lights[0].is_on);
}

TEST_F(SceneAtTest, PointersChangeCameras) {
  gltf_.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 1}, {"znear", 1}}}},
                           {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}}}}};
  gltf_.add_node({{"camera", 0}});
  gltf_.add_node({{"camera", 1}});
  animate(gltf_, 0, "/cameras/0/perspective/yfov", {0, 1}, {1, 2}, "SCALAR");
  animate(gltf_, 0, "/cameras/0/perspective/aspectRatio", {0, 1}, {1, 2}, "SCALAR");
  animate(gltf_, 0, "/cameras/0/perspective/znear", {0, 1}, {1, -9}, "SCALAR");
  animate(gltf_, 0, "/cameras/1/orthographic/xmag", {0, 1}, {1, 5}, "SCALAR");
  animate(gltf_, 0, "/cameras/1/orthographic/ymag", {0, 1}, {1, 2}, "SCALAR");
  const Scene posed = at(0.5);
  EXPECT_EQ(posed.cameras[0].yfov, 1.5F);
  EXPECT_EQ(posed.cameras[0].aspect_ratio, 1.5F);
  EXPECT_EQ(posed.cameras[0].near, 0.0F) << "values are clamped";
  EXPECT_EQ(posed.cameras[1].ymag, 1.5F);
  EXPECT_EQ(posed.cameras[1].aspect_ratio, 2.0F);
  EXPECT_TRUE(validate(posed).empty());
}

TEST_F(SceneAtTest, PointersChangeTheTransformsOfTextures) {
  gltf_.json["images"] = {{{"uri", "none.png"}}};
  gltf_.json["textures"] = {{{"source", 0}}};
  const json transform = {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 0.25}, {"scale", {2, 3}}}}};
  gltf_.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"extensions", transform}}}}},
       {"emissiveFactor", {1, 1, 1}},
       {"emissiveTexture", {{"index", 0}}},
       {"extensions", {{"KHR_materials_sheen", {{"sheenColorTexture", {{"index", 0}}}}}}}},
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
       {"extensions", {{"KHR_materials_unlit", json::object()}}}}};
  gltf_.json["meshes"][0]["primitives"][0]["material"] = 0;
  const std::string base = "/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/";
  animate(gltf_, 0, "/materials/0" + base + "offset", {0, 1}, {0, 0, 2, 4}, "VEC2");
  animate(gltf_, 0, "/materials/0/emissiveTexture/extensions/KHR_texture_transform/rotation", {0, 1}, {0, 3}, "SCALAR");
  animate(gltf_, 0,
          "/materials/0/extensions/KHR_materials_sheen/sheenColorTexture/extensions/KHR_texture_transform/scale",
          {0, 1}, {1, 1, 3, 5}, "VEC2");
  animate(gltf_, 0, "/materials/1" + base + "offset", {0, 1}, {0, 0, 1, 1}, "VEC2");
  const Scene posed = at(0.5);
  const auto& model = std::get<MetallicRoughness>(posed.materials[0].model);
  const auto cosine = static_cast<float>(std::cos(0.25));
  const auto sine = static_cast<float>(std::sin(0.25));
  expect_near(model.base_color_texture.to_u, vec3(2 * cosine, 3 * sine, 1), 1e-6F);
  expect_near(model.base_color_texture.to_v, vec3(-2 * sine, 3 * cosine, 2), 1e-6F);
  const auto turned = static_cast<float>(std::sin(1.5));
  expect_near(posed.materials[0].emissive_texture.to_v, vec3(-turned, std::cos(1.5F), 0), 1e-6F);
  EXPECT_EQ(model.sheen_color_texture.to_u, vec3(2, 0, 0));
  EXPECT_EQ(model.sheen_color_texture.to_v, vec3(0, 3, 0));
  EXPECT_EQ(std::get<Unlit>(posed.materials[1].model).color_texture.to_u, vec3(1, 0, 0.5F));
  EXPECT_TRUE(validate(posed).empty());
}

TEST_F(SceneAtTest, PointersChangeMaterials) {
  gltf_.json["materials"] = {{{"emissiveFactor", {1, 0.5, 0}},
                              {"extensions",
                               {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}},
                                {"KHR_materials_sheen", json::object()},
                                {"KHR_materials_clearcoat", json::object()}}}},
                             {{"extensions", {{"KHR_materials_unlit", json::object()}}}}};
  gltf_.json["meshes"][0]["primitives"][0]["material"] = 0;
  animate(gltf_, 0, "/materials/0/pbrMetallicRoughness/baseColorFactor", {0, 1}, {1, 1, 1, 1, 0, 0, 3, 0}, "VEC4");
  animate(gltf_, 0, "/materials/1/pbrMetallicRoughness/baseColorFactor", {0, 1}, {1, 1, 1, 1, 0, 0, 1, 0}, "VEC4");
  animate(gltf_, 0, "/materials/0/emissiveFactor", {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
  animate(gltf_, 0, "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", {0, 1}, {0, 8},
          "SCALAR");
  animate(gltf_, 0, "/materials/0/alphaCutoff", {0, 1}, {0, 1}, "SCALAR");
  animate(gltf_, 0, "/materials/0/pbrMetallicRoughness/metallicFactor", {0, 1}, {0, 1}, "SCALAR");
  animate(gltf_, 0, "/materials/0/extensions/KHR_materials_sheen/sheenColorFactor", {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
  animate(gltf_, 0, "/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", {0, 1}, {0, 1}, "SCALAR");
  const Scene posed = at(0.5);
  const Material& material = posed.materials[0];
  const auto& model = std::get<MetallicRoughness>(material.model);
  EXPECT_EQ(model.base_color, vec3(0.5F, 0.5F, 1)) << "values are clamped";
  EXPECT_EQ(material.alpha, 0.5F);
  EXPECT_EQ(material.emissive, vec3(2)) << "factor and strength multiply";
  EXPECT_EQ(material.alpha_cutoff, 0.5F);
  EXPECT_EQ(model.metallic, 0.5F);
  EXPECT_EQ(model.sheen_color, vec3(0.5F));
  EXPECT_EQ(model.clearcoat, 0.5F);
  EXPECT_EQ(std::get<Unlit>(posed.materials[1].model).color, vec3(0.5F, 0.5F, 1));
  EXPECT_EQ(scene_at(posed, {}).materials[0].emissive, vec3(2, 1, 0));
}

TEST_F(SceneAtTest, RefusesWhatDoesNotExist) {
  animate(gltf_, 0, "/nodes/0/translation", {0, 2}, {0, 0, 0, 2, 0, 0}, "VEC3");
  const Scene scene = load();
  const auto refusal = [](const Scene& posed, const PoseChoice& choice) {
    return message_of([&] { scene_at(posed, choice); });
  };
  EXPECT_THAT(refusal(scene, {.animations = {1}}), HasProblem("motion.animation.missing"));
  EXPECT_THAT(refusal(scene, {.animations = {0}, .time_s = std::nan("")}), HasProblem("motion.time.range"));
  EXPECT_THAT(refusal(Scene{}, {.animations = {0}}), HasProblem("motion.scene.none"));
  EXPECT_TRUE(scene_at(Scene{}, {}).objects.empty());
}

TEST_F(SceneAtTest, RefusesPositionsThatOverflow) {
  gltf_.add_node({{"children", {0}}});
  animate(gltf_, 0, "/nodes/0/scale", {0, 1}, {1, 1, 1, 1e20F, 1, 1}, "VEC3");
  EXPECT_THAT(message_of([&] { at(1.0); }), HasProblem("motion.position.far"));
  std::string deep;
  for (int i = 0; i < 12; ++i) {
    const size_t node = gltf_.add_node({{"children", {gltf_.json["nodes"].size() - 1}}});
    animate(gltf_, 1, "/nodes/" + std::to_string(node) + "/scale", {0, 1}, {1, 1, 1, 1e38F, 1e38F, 1e38F}, "VEC3");
  }
  const Scene scene = load();
  EXPECT_THAT(message_of([&] { scene_at(scene, {.animations = {1}, .time_s = 1.0}); }), HasProblem("motion.node.far"));
}

/// A change of a scene's motion that makes it invalid.
struct Flaw {
  const char* code;
  void (*make)(Motion& motion);
};

class FlawTest : public SceneAtTest, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawTest, IsRefused) {
  gltf_.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] =
      gltf_.add<uint8_t>(std::vector<uint8_t>(12), "VEC4");
  gltf_.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
      gltf_.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  gltf_.json["nodes"][0]["skin"] = 0;
  gltf_.add_node({{"children", {0}}});
  gltf_.json["skins"] = {{{"joints", {1}}}};
  animate(gltf_, 0, "/nodes/1/translation", {0, 2}, {0, 0, 0, 2, 0, 0}, "VEC3");
  Scene scene = load();
  Motion motion = *scene.motion;
  GetParam().make(motion);
  scene.motion = std::make_shared<const Motion>(std::move(motion));
  EXPECT_THAT(message_of([&] { pose_of(scene, {}); }), HasProblem(GetParam().code));
}

INSTANTIATE_TEST_SUITE_P(
    Motion, FlawTest,
    testing::Values(Flaw{"motion.reference.range", [](Motion& m) { m.nodes[0].parent = 9; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.nodes[0].same_as = 9; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.nodes[0].same_as = 0; }},
                    Flaw{"motion.node.cycle", [](Motion& m) { m.nodes[1].parent = 0; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.skins[0].joints[0] = 9; }},
                    Flaw{"motion.count.wrong", [](Motion& m) { m.skins[0].inverse_bind.resize(3); }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.meshes[0] = nullptr; }},
                    Flaw{"motion.reference.range",
                         [](Motion& m) {
                           DeformingMesh mesh = *m.meshes[0];
                           mesh.influences.joints[0] = 7;
                           m.meshes[0] = std::make_shared<const DeformingMesh>(std::move(mesh));
                         }},
                    Flaw{"motion.count.wrong",
                         [](Motion& m) {
                           DeformingMesh mesh = *m.meshes[0];
                           mesh.influences.weights.pop_back();
                           m.meshes[0] = std::make_shared<const DeformingMesh>(std::move(mesh));
                         }},
                    Flaw{"motion.count.wrong",
                         [](Motion& m) {
                           DeformingMesh mesh = *m.meshes[0];
                           mesh.targets.emplace_back().positions.resize(2);
                           m.meshes[0] = std::make_shared<const DeformingMesh>(std::move(mesh));
                         }},
                    Flaw{"motion.keys.order",
                         [](Motion& m) {
                           m.animations[0].samplers[0].times = {1, 1};
                         }},
                    Flaw{"motion.keys.order",
                         [](Motion& m) {
                           m.animations[0].samplers[0].times = {0, NAN};
                         }},
                    Flaw{"motion.keys.order", [](Motion& m) { m.animations[0].samplers[0].times.clear(); }},
                    Flaw{"motion.count.wrong", [](Motion& m) { m.animations[0].samplers[0].values.pop_back(); }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.animations[0].channels[0].sampler = 5; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.animations[0].channels[0].target = 5; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.objects[0].node = 5; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.objects[0].mesh = 5; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.objects[0].geometry = 5; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.objects[0].place = 5; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.materials.emplace_back().material = 5; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.lights.emplace_back().node = 5; }},
                    Flaw{"motion.reference.range", [](Motion& m) { m.cameras.emplace_back().node = 5; }},
                    Flaw{"motion.count.wrong", [](Motion& m) { m.objects.resize(9); }}));

}  // namespace
}  // namespace promin
