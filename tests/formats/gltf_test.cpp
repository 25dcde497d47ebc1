// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <numbers>

#include "core/file.h"
#include "environment/sky_radiance.h"
#include "formats/gltf/buffers.h"
#include "promin/image.h"
#include "scene/glass.h"
#include "support/expect_near.h"
#include "support/gltf_builder.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using nlohmann::json;
using test::expect_near;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

class GltfTest : public SceneFolder {
 protected:
  LoadedScene load(GltfBuilder& gltf) const { return SceneFolder::load("scene.gltf", gltf.text()); }
  LoadedScene load(GltfBuilder&& gltf) const { return load(gltf); }
};

const std::vector<float> kSquarePlaces = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

// The next tests check meshes.

TEST_F(GltfTest, TrianglesComeOutInTheWorld) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["nodes"][0].update({{"translation", {10, 0, 0}},
                                {"rotation", {0, 0, 0.70710678118654752, 0.70710678118654752}},
                                {"scale", {2, 3, 4}}});
  const LoadedScene scene = load(gltf);
  const std::vector<vec3> corners = corners_of(mesh_of(scene));
  ASSERT_THAT(corners, SizeIs(3));
  expect_near(corners[0], {10, 0, 0});
  expect_near(corners[1], {10, 2, 0});
  expect_near(corners[2], {7, 0, 0});
  EXPECT_THAT(mesh_of(scene).normals, IsEmpty());
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(GltfTest, MatricesMultiplyDownTheTree) {
  GltfBuilder gltf = triangle_gltf();
  gltf.add_node({{"children", {0}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
  gltf.json["nodes"][0]["scale"] = {2, 2, 2};
  expect_near(corners_of(mesh_of(load(gltf)))[1], {7, 6, 7});
}

template <class Index>
class GltfIndexTest : public SceneFolder {};
using IndexTypes = testing::Types<uint8_t, uint16_t, uint32_t>;
TYPED_TEST_SUITE(GltfIndexTest, IndexTypes);

TYPED_TEST(GltfIndexTest, EveryIndexTypeIsRead) {
  GltfBuilder gltf;
  const size_t positions = gltf.add<float>(kSquarePlaces, "VEC3");
  const size_t indices = gltf.add<TypeParam>({2, 1, 3}, "SCALAR");
  gltf.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  const LoadedScene scene = this->load("scene.gltf", gltf.text());
  EXPECT_THAT(corners_of(mesh_of(scene)), ElementsAre(vec3(0, 1, 0), vec3(1, 0, 0), vec3(1, 1, 0)));
  EXPECT_THAT(mesh_of(scene).positions, SizeIs(3)) << "vertices that no triangle uses are left out";
}

TEST_F(GltfTest, QuantizedPositionsAreScaledWhenNormalized) {
  const auto first_corner = [&](auto numbers, bool normalized) {
    GltfBuilder gltf;
    gltf.show({{"attributes", {{"POSITION", gltf.add(numbers, "VEC3", normalized)}}}});
    return corners_of(mesh_of(load(gltf)))[0];
  };
  EXPECT_EQ(first_corner(std::vector<int8_t>{-128, 127, 5, 0, 0, 0, 1, 2, 3}, true), vec3(-1, 1, 5.0F / 127));
  EXPECT_EQ(first_corner(std::vector<int8_t>{-128, 127, 5, 0, 0, 0, 1, 2, 3}, false), vec3(-128, 127, 5));
  EXPECT_EQ(first_corner(std::vector<uint8_t>{255, 0, 51, 0, 0, 0, 1, 2, 3}, true), vec3(1, 0, 0.2F));
  EXPECT_EQ(first_corner(std::vector<int16_t>{-32768, 32767, 0, 0, 0, 0, 1, 2, 3}, true), vec3(-1, 1, 0));
  EXPECT_EQ(first_corner(std::vector<uint16_t>{65535, 1, 2, 0, 0, 0, 1, 2, 3}, false), vec3(65535, 1, 2));
}

TEST_F(GltfTest, StripsAlternateAndFansTurn) {
  for (const auto& [mode, wanted] : std::vector<std::pair<int, std::vector<uvec3>>>{
           {4, {{0, 1, 2}}}, {5, {{0, 1, 2}, {1, 3, 2}}}, {6, {{1, 2, 0}, {2, 3, 0}}}}) {
    GltfBuilder gltf;
    gltf.show({{"attributes", {{"POSITION", gltf.add<float>(kSquarePlaces, "VEC3")}}}, {"mode", mode}});
    const LoadedScene scene = load(gltf);
    EXPECT_EQ(mesh_of(scene).triangles, wanted) << "mode " << mode;
    EXPECT_EQ(scene.warnings.size(), mode == 4 ? 1U : 0U) << "the fourth corner is no triangle";
  }
}

TEST_F(GltfTest, PointsAndLinesTakeANumberButAreNotDrawn) {
  GltfBuilder gltf;
  const size_t positions = gltf.add<float>(kSquarePlaces, "VEC3");
  for (const int mode : {0, 1, 2, 3, 5}) gltf.show({{"attributes", {{"POSITION", positions}}}, {"mode", mode}});
  const LoadedScene scene = load(gltf);
  ASSERT_THAT(scene.objects, SizeIs(5));
  for (size_t i = 0; i < 4; ++i) EXPECT_TRUE(std::holds_alternative<world::NotDrawn>(scene.objects[i].shape));
  EXPECT_TRUE(std::holds_alternative<Mesh>(scene.objects[4].shape));
  EXPECT_THAT(
      scene.warnings,
      ElementsAre(
          "meshes[0].primitives[0]: a mesh primitive contains points or lines, and 3 more; promin does not draw them"));
}

TEST_F(GltfTest, SparseAccessorsReplaceElements) {
  GltfBuilder gltf = triangle_gltf();
  const size_t indices = gltf.add_view<uint8_t>({2});
  const size_t values = gltf.add_view<float>({7, 8, 9});
  gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_THAT(corners_of(mesh_of(load(gltf))), ElementsAre(vec3(0), vec3(1, 0, 0), vec3(7, 8, 9)));
  gltf.json["accessors"][0].erase("bufferView");
  EXPECT_THAT(corners_of(mesh_of(load(gltf))), ElementsAre(vec3(0), vec3(0), vec3(7, 8, 9)));
}

TEST_F(GltfTest, InterleavedAttributesAreTakenApart) {
  GltfBuilder gltf;
  const size_t view = gltf.add_view<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1});
  gltf.json["bufferViews"][view]["byteStride"] = 24;
  for (const int offset : {0, 12}) {
    gltf.json["accessors"].push_back(
        {{"bufferView", view}, {"byteOffset", offset}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  }
  gltf.show({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}});
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(corners_of(mesh_of(scene)), ElementsAre(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)));
  EXPECT_THAT(mesh_of(scene).normals, ElementsAre(vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 0, 1)));
}

TEST_F(GltfTest, MirroringKeepsCounterClockwiseOutside) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      gltf.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  gltf.json["nodes"][0]["scale"] = {-1, 1, 1};
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(corners_of(mesh_of(scene)), ElementsAre(vec3(0), vec3(0, 1, 0), vec3(-1, 0, 0)));
  EXPECT_EQ(mesh_of(scene).normals[0], vec3(0, 0, 1));
}

TEST_F(GltfTest, NormalsGoWithTheInverseTranspose) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      gltf.add<float>({1, 1, 0, 1, 1, 0, 1, 1, 0}, "VEC3");
  gltf.json["nodes"][0]["scale"] = {2, 1, 1};
  expect_near(mesh_of(load(gltf)).normals[0], glm::normalize(vec3(0.5F, 1, 0)));
}

TEST_F(GltfTest, NormalsWithoutLengthMakeTheMeshSharp) {
  for (const float bad : {0.0F, std::numeric_limits<float>::quiet_NaN()}) {
    GltfBuilder gltf = triangle_gltf();
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        gltf.add<float>({0, 0, 1, bad, bad, bad, 0, 0, 1}, "VEC3");
    const LoadedScene scene = load(gltf);
    EXPECT_THAT(mesh_of(scene).normals, IsEmpty());
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("flat shading")));
  }
}

TEST_F(GltfTest, VertexColorsComeInEveryFormat) {
  const auto second_color = [&](auto numbers, const char* type, bool normalized) {
    GltfBuilder gltf = triangle_gltf();
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = gltf.add(numbers, type, normalized);
    return mesh_of(load(gltf)).colors.at(1);
  };
  EXPECT_EQ(second_color(std::vector<float>{0, 0, 0, .25F, .5F, 2, 0, 0, 0}, "VEC3", false), vec4(.25F, .5F, 2, 1));
  EXPECT_EQ(second_color(std::vector<uint8_t>{0, 0, 0, 0, 255, 0, 51, 102, 0, 0, 0, 0}, "VEC4", true),
            vec4(1, 0, 0.2F, 0.4F));
  EXPECT_EQ(second_color(std::vector<uint16_t>{0, 0, 0, 65535, 0, 0, 0, 0, 0}, "VEC3", true), vec4(1, 0, 0, 1));
}

// The next tests check nodes.

TEST_F(GltfTest, ObjectsAreNumberedDepthFirst) {
  GltfBuilder gltf = triangle_gltf();  // node 0
  for (const char* name : {"a", "b", "c", "d"}) gltf.add_node({{"mesh", 0}, {"name", name}});
  gltf.json["nodes"][3]["children"] = {1, 2};
  gltf.json["scenes"] = {{{"nodes", {4, 3}}}};
  const LoadedScene scene = load(gltf);
  std::vector<std::string> names;
  for (const world::Object& object : scene.objects) names.push_back(object.name);
  EXPECT_THAT(names, ElementsAre("d", "c", "a", "b"));
}

TEST_F(GltfTest, TheDefaultSceneIsShown) {
  GltfBuilder gltf = triangle_gltf();
  gltf.add_node({{"mesh", 0}});
  gltf.json["scenes"] = {{{"nodes", json::array()}}, {{"nodes", {0, 1}}}};
  EXPECT_THAT(load(gltf).warnings, Contains("the scene contains nothing to draw"));
  gltf.json["scene"] = 1;
  EXPECT_THAT(load(gltf).objects, SizeIs(2));
}

TEST_F(GltfTest, InvisibleNodesKeepTheirNumbers) {
  GltfBuilder gltf = triangle_gltf();
  gltf.add_node({{"mesh", 0}, {"children", {0}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  const LoadedScene scene = load(gltf);
  ASSERT_THAT(scene.objects, SizeIs(2));
  for (const world::Object& object : scene.objects) EXPECT_TRUE(std::holds_alternative<world::NotDrawn>(object.shape));
}

TEST_F(GltfTest, DeepHierarchiesDoNotOverflowTheStack) {
  GltfBuilder gltf = triangle_gltf();
  constexpr size_t kDepth = 20'000;
  for (size_t i = 0; i < kDepth; ++i) gltf.add_node({{"children", {i}}, {"translation", {1, 0, 0}}});
  const vec3 corner = corners_of(mesh_of(load(gltf)))[0];
  EXPECT_EQ(load_scene(folder_ / "scene.gltf").center + dvec3(corner), dvec3(kDepth, 0, 0));
}

// The next tests check shapes.

/// Returns a document of one implicit shape, with a triangle as its fallback.
GltfBuilder shape_gltf(const json& shape, const json& node = json::object()) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["extensions"]["KHR_implicit_shapes"]["shapes"] = {shape};
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["PROMIN_mesh_primitive_implicit_shape"]["shape"] = 0;
  gltf.json["nodes"][0].update(node);
  return gltf;
}

TEST_F(GltfTest, SpheresScaleAndMove) {
  const LoadedScene scene = load(shape_gltf({{"type", "sphere"}, {"sphere", {{"radius", 2}}}},
                                            {{"translation", {1, 2, 3}}, {"scale", {-3, 3, 3}}}));
  const auto& sphere = std::get<world::Sphere>(scene.objects.at(0).shape);
  EXPECT_EQ(sphere.center, vec3(1, 2, 3));
  EXPECT_EQ(sphere.radius, 6.0F);
}

TEST_F(GltfTest, ShapesHaveTheReleaseCandidatesDefaults) {
  EXPECT_EQ(std::get<world::Sphere>(load(shape_gltf({{"type", "sphere"}})).objects[0].shape).radius, 0.5F);
  const LoadedScene scene = load(shape_gltf({{"type", "cylinder"}}));
  const auto& cylinder = std::get<world::Cylinder>(scene.objects[0].shape);
  EXPECT_EQ(cylinder.half_height, 0.25F);
  EXPECT_EQ(cylinder.radius, 0.25F);
  EXPECT_EQ(cylinder.axis, vec3(0, 1, 0));
}

TEST_F(GltfTest, CylindersStretchAlongTheirAxis) {
  const json shape = {{"type", "cylinder"}, {"cylinder", {{"height", 4}, {"radiusTop", 1}, {"radiusBottom", 1}}}};
  const LoadedScene scene =
      load(shape_gltf(shape, {{"rotation", {0, 0, -0.70710678118654752, 0.70710678118654752}}, {"scale", {2, 5, 2}}}));
  const auto& cylinder = std::get<world::Cylinder>(scene.objects[0].shape);
  expect_near(cylinder.axis, {1, 0, 0});
  EXPECT_FLOAT_EQ(cylinder.half_height, 10);
  EXPECT_FLOAT_EQ(cylinder.radius, 2);
}

TEST_F(GltfTest, TwoRadiiMakeAConeOrAFrustum) {
  for (const double top : {0.0, 0.5}) {
    const json shape = {{"type", "cylinder"}, {"cylinder", {{"height", 2}, {"radiusTop", top}, {"radiusBottom", 1}}}};
    const LoadedScene scene = load(shape_gltf(shape, {{"scale", {2, -1, 2}}}));
    const auto& cone = std::get<world::Cone>(scene.objects[0].shape);
    EXPECT_EQ(cone.axis, vec3(0, -1, 0)) << "the top stays at the axis' end";
    EXPECT_EQ(cone.radius_top, static_cast<float>(2 * top));
    EXPECT_EQ(cone.radius_bottom, 2.0F);
    EXPECT_EQ(cone.half_height, 1.0F);
  }
}

TEST_F(GltfTest, BoxesStretchAndTurn) {
  const auto box_of = [&](const json& node, const json& size = {2, 4, 6}) {
    return std::get<world::Box>(load(shape_gltf({{"type", "box"}, {"box", {{"size", size}}}}, node)).objects[0].shape);
  };
  const world::Box plain = box_of({{"translation", {1, 2, 3}}});
  EXPECT_EQ(plain.center, vec3(1, 2, 3));
  EXPECT_EQ(plain.half_size, vec3(1, 2, 3));
  EXPECT_EQ(plain.turn, vec3(0));
  EXPECT_EQ(box_of({{"scale", {-3, 2, 1}}}).half_size, vec3(3, 4, 3));
  // A quarter turn only permutes the axes, which is exact.
  const world::Box quarter = box_of({{"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
  EXPECT_EQ(quarter.half_size, vec3(2, 1, 3));
  EXPECT_EQ(quarter.turn, vec3(0));
  // This rotation is 30 degrees about x.
  const world::Box turned = box_of({{"rotation", {std::sin(0.2617993877991494), 0, 0, std::cos(0.2617993877991494)}}});
  EXPECT_EQ(turned.half_size, vec3(1, 2, 3));
  expect_near(turned.turn, {0.25881905F, 0, 0});
  // A rotation of 75 degrees about x is one of -15 degrees with two axes exchanged.
  const world::Box more = box_of({{"rotation", {std::sin(0.6544984694978736), 0, 0, std::cos(0.6544984694978736)}}});
  EXPECT_EQ(more.half_size, vec3(1, 3, 2));
  expect_near(more.turn, {-0.13052619F, 0, 0});
  EXPECT_EQ(std::get<world::Box>(load(shape_gltf({{"type", "box"}})).objects[0].shape).half_size, vec3(0.5F));
}

TEST_F(GltfTest, CapsulesScaleAndTurn) {
  const json shape = {{"type", "capsule"}, {"capsule", {{"height", 4}, {"radiusTop", 1}, {"radiusBottom", 2}}}};
  const LoadedScene scene =
      load(shape_gltf(shape, {{"rotation", {0, 0, -0.70710678118654752, 0.70710678118654752}}, {"scale", {3, 3, 3}}}));
  const auto& capsule = std::get<world::Capsule>(scene.objects[0].shape);
  expect_near(capsule.axis, {1, 0, 0});
  EXPECT_FLOAT_EQ(capsule.half_height, 6);
  EXPECT_FLOAT_EQ(capsule.radius_bottom, 6);
  EXPECT_FLOAT_EQ(capsule.radius_top, 3);
  const LoadedScene defaults = load(shape_gltf({{"type", "capsule"}}));
  const auto& pill = std::get<world::Capsule>(defaults.objects[0].shape);
  EXPECT_EQ(vec3(pill.half_height, pill.radius_bottom, pill.radius_top), vec3(0.25F));
}

TEST_F(GltfTest, PlanesTurnTheirNormal) {
  const LoadedScene scene =
      load(shape_gltf({{"type", "plane"}}, {{"translation", {0, 3, 0}}, {"rotation", {0, 0, 1, 0}}}));
  const auto& plane = std::get<world::Plane>(scene.objects[0].shape);
  EXPECT_EQ(plane.point, vec3(0, 3, 0));
  expect_near(plane.normal, {0, -1, 0});
  const LoadedScene mirrored = load(shape_gltf({{"type", "plane"}}, {{"scale", {1, -1, 1}}}));
  EXPECT_EQ(std::get<world::Plane>(mirrored.objects[0].shape).normal, vec3(0, -1, 0));
}

TEST_F(GltfTest, WhatIsNoAnalyticShapeShowsItsFallback) {
  const std::vector<std::pair<json, json>> cases = {
      {{{"type", "box"}}, {{"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}},
      {{{"type", "capsule"}}, {{"scale", {1, 2, 1}}}},
      {{{"type", "plane"}, {"plane", {{"sizeX", 1}, {"sizeZ", 1}}}}, {}},
      {{{"type", "sphere"}}, {{"scale", {1, 2, 1}}}},
      {{{"type", "cylinder"}}, {{"scale", {1, 1, 2}}}},
      {{{"type", "cylinder"}}, {{"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}},
  };
  for (const auto& [shape, node] : cases) {
    const json changes = node.is_null() ? json::object() : node;
    const LoadedScene scene = load(shape_gltf(shape, changes));
    EXPECT_TRUE(std::holds_alternative<Mesh>(scene.objects.at(0).shape)) << shape << node;
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("shapes[0]")));

    GltfBuilder bare = shape_gltf(shape, changes);
    bare.json["meshes"][0]["primitives"][0]["attributes"] = json::object();
    bare.json["meshes"][0]["primitives"][0].erase("indices");
    EXPECT_THAT(refusal("scene.gltf", bare.text()), HasProblem("scene.geometry.none"));
    bare.show({{"attributes", {{"POSITION", 0}}}});
    const LoadedScene nothing = load(bare);
    EXPECT_TRUE(std::holds_alternative<world::NotDrawn>(nothing.objects.at(0).shape));
    EXPECT_THAT(nothing.warnings, Contains(HasSubstr("no POSITION")));
  }
}

TEST_F(GltfTest, CollidersAreNotDrawn) {
  GltfBuilder gltf = shape_gltf({{"type", "sphere"}});
  gltf.json["extensionsUsed"] = {"KHR_physics_rigid_bodies"};
  gltf.add_node({{"extensions", {{"KHR_physics_rigid_bodies", {{"collider", {{"geometry", {{"shape", 0}}}}}}}}}});
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.objects, SizeIs(1));
  EXPECT_THAT(scene.warnings, ElementsAre("the extension KHR_physics_rigid_bodies is ignored"));
}

// The next tests check materials.

/// Returns a document whose triangle has this material.
GltfBuilder material_gltf(const json& material) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["materials"] = {material};
  gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
  return gltf;
}

TEST_F(GltfTest, PhongMaterialsAreTakenAsTheyAre) {
  const LoadedScene scene = load(material_gltf({{"name", "m"},
                                                {"emissiveFactor", {1, 0, 0}},
                                                {"extensions",
                                                 {{"PROMIN_materials_phong",
                                                   {{"ambientFactor", {0.1, 0.2, 0.3}},
                                                    {"diffuseFactor", {0.4, 0.5, 0.6}},
                                                    {"specularFactor", {2, 2, 2}},
                                                    {"shininess", 64},
                                                    {"reflectionFactor", {0.7, 0.8, 0.9}}}},
                                                  {"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}}}}}));
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.phong().ambient, vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(material.phong().diffuse, vec3(0.4F, 0.5F, 0.6F));
  EXPECT_EQ(material.phong().specular, vec3(2));
  EXPECT_EQ(material.phong().shininess, 64);
  EXPECT_EQ(material.phong().reflection, vec3(0.7F, 0.8F, 0.9F));
  EXPECT_EQ(material.emissive, vec3(3, 0, 0));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(GltfTest, PhongMaterialsFallBackOnTheBaseColor) {
  const LoadedScene scene = load(material_gltf({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0, 1}}}},
                                                {"extensions", {{"PROMIN_materials_phong", json::object()}}}}));
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.phong().diffuse, vec3(0.5F, 0.25F, 0));
  EXPECT_EQ(material.phong().ambient, material.phong().diffuse);
  EXPECT_EQ(material.phong().specular, vec3(0));
  EXPECT_EQ(material.phong().shininess, 0);
  EXPECT_EQ(material.phong().reflection, vec3(0));
}

/// Returns the model of the file's only material.
template <class Model>
Model model_of(const LoadedScene& scene) {
  return std::get<Model>(scene.materials.at(0).model);
}

TEST_F(GltfTest, MetallicRoughnessIsTakenAsItIs) {
  const LoadedScene scene = load(material_gltf(
      {{"emissiveFactor", {0, 0.5, 0}},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.8, 0.4, 0.2, 1}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.15}}},
       {"extensions",
        {{"KHR_materials_ior", {{"ior", 1.25}}},
         {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
         {"KHR_materials_specular", {{"specularFactor", 0.75}, {"specularColorFactor", {1, 2, 0.5}}}}}}}));
  const auto model = model_of<MetallicRoughness>(scene);
  EXPECT_EQ(model.base_color, vec3(0.8F, 0.4F, 0.2F));
  EXPECT_EQ(model.metallic, 0.5F);
  EXPECT_EQ(model.roughness, 0.15F);
  EXPECT_EQ(model.ior, 1.25F);
  EXPECT_EQ(model.specular, 0.75F);
  EXPECT_EQ(model.specular_color, vec3(1, 2, 0.5F));
  EXPECT_EQ(scene.materials.at(0).emissive, vec3(0, 2, 0));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(GltfTest, ClearCoatsAreRead) {
  const LoadedScene scene = load(material_gltf(
      {{"extensions",
        {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.75}, {"clearcoatRoughnessFactor", 0.25}}}}}}));
  const auto model = model_of<MetallicRoughness>(scene);
  EXPECT_EQ(model.clearcoat, 0.75F);
  EXPECT_EQ(model.clearcoat_roughness, 0.25F);
  EXPECT_THAT(scene.warnings, IsEmpty());
  const auto bare =
      model_of<MetallicRoughness>(load(material_gltf({{"extensions", {{"KHR_materials_clearcoat", json::object()}}}})));
  EXPECT_EQ(bare.clearcoat, 0.0F);
}

TEST_F(GltfTest, SheensAreRead) {
  const LoadedScene scene = load(material_gltf(
      {{"extensions",
        {{"KHR_materials_sheen", {{"sheenColorFactor", {0.5, 0.25, 1}}, {"sheenRoughnessFactor", 0.75}}}}}}));
  const auto model = model_of<MetallicRoughness>(scene);
  EXPECT_EQ(model.sheen_color, vec3(0.5F, 0.25F, 1.0F));
  EXPECT_EQ(model.sheen_roughness, 0.75F);
  EXPECT_THAT(scene.warnings, IsEmpty());
  const auto bare =
      model_of<MetallicRoughness>(load(material_gltf({{"extensions", {{"KHR_materials_sheen", json::object()}}}})));
  EXPECT_EQ(bare.sheen_color, vec3(0.0F));
}

TEST_F(GltfTest, DiffuseTransmissionIsRead) {
  const LoadedScene scene = load(
      material_gltf({{"extensions",
                      {{"KHR_materials_diffuse_transmission",
                        {{"diffuseTransmissionFactor", 0.75}, {"diffuseTransmissionColorFactor", {0.5, 0.25, 1}}}}}}}));
  const auto model = model_of<MetallicRoughness>(scene);
  EXPECT_EQ(model.diffuse_transmission, 0.75F);
  EXPECT_EQ(model.diffuse_transmission_color, vec3(0.5F, 0.25F, 1.0F));
  EXPECT_THAT(scene.warnings, IsEmpty());
  const auto bare = model_of<MetallicRoughness>(
      load(material_gltf({{"extensions", {{"KHR_materials_diffuse_transmission", json::object()}}}})));
  EXPECT_EQ(bare.diffuse_transmission, 0.0F);
  EXPECT_EQ(bare.diffuse_transmission_color, vec3(1.0F));
}

TEST_F(GltfTest, IridescenceAndAnisotropyAreRead) {
  const LoadedScene scene = load(
      material_gltf({{"extensions",
                      {{"KHR_materials_iridescence",
                        {{"iridescenceFactor", 0.75},
                         {"iridescenceIor", 1.5},
                         {"iridescenceThicknessMinimum", 600},
                         {"iridescenceThicknessMaximum", 200}}},
                       {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}, {"anisotropyRotation", -2.5}}}}}}));
  const auto model = model_of<MetallicRoughness>(scene);
  EXPECT_EQ(model.iridescence, 0.75F);
  EXPECT_EQ(model.iridescence_ior, 1.5F);
  EXPECT_EQ(model.iridescence_thickness_minimum, 600.0F);
  EXPECT_EQ(model.iridescence_thickness_maximum, 200.0F);
  EXPECT_EQ(model.anisotropy, 0.5F);
  EXPECT_EQ(model.anisotropy_rotation, -2.5F);
  EXPECT_THAT(scene.warnings, IsEmpty());
  const auto bare = model_of<MetallicRoughness>(load(material_gltf(
      {{"extensions",
        {{"KHR_materials_iridescence", json::object()}, {"KHR_materials_anisotropy", json::object()}}}})));
  EXPECT_EQ(bare.iridescence, 0.0F);
  EXPECT_EQ(bare.iridescence_ior, 1.3F);
  EXPECT_EQ(bare.iridescence_thickness_minimum, 100.0F);
  EXPECT_EQ(bare.iridescence_thickness_maximum, 400.0F);
  EXPECT_EQ(bare.anisotropy, 0.0F);
}

// An index below 1 becomes the default, unless it is 1 with a rounding error.
TEST_F(GltfTest, ARoundedIndexIsNotReplaced) {
  const auto read_ior = [&](double ior) {
    const LoadedScene scene = load(material_gltf(
        {{"extensions", {{"KHR_materials_iridescence", {{"iridescenceFactor", 1}, {"iridescenceIor", ior}}}}}}));
    return std::pair(model_of<MetallicRoughness>(scene).iridescence_ior, scene.warnings.size());
  };
  EXPECT_EQ(read_ior(0.9995), std::pair(1.0F, size_t{0}));
  EXPECT_EQ(read_ior(0.9), std::pair(1.3F, size_t{1}));
}

TEST_F(GltfTest, MetallicRoughnessHasTheSpecificationsDefaults) {
  const auto model = model_of<MetallicRoughness>(load(material_gltf(
      {{"extensions", {{"KHR_materials_ior", json::object()}, {"KHR_materials_specular", json::object()}}}})));
  EXPECT_EQ(model.base_color, vec3(1));
  EXPECT_EQ(model.metallic, 1.0F);
  EXPECT_EQ(model.roughness, 1.0F);
  EXPECT_EQ(model.ior, 1.5F);
  EXPECT_EQ(model.specular, 1.0F);
  EXPECT_EQ(model.specular_color, vec3(1));
}

// In KHR_materials_ior, 0 stands for a material that reflects everything.
TEST_F(GltfTest, AnIndexOfRefractionIsZeroOrFromOneOn) {
  const auto load_ior = [this](double ior) {
    return load(material_gltf({{"extensions", {{"KHR_materials_ior", {{"ior", ior}}}}}}));
  };
  EXPECT_EQ(model_of<MetallicRoughness>(load_ior(0)).ior, 0.0F);
  EXPECT_EQ(model_of<MetallicRoughness>(load_ior(1)).ior, 1.0F);
  const LoadedScene odd = load_ior(0.5);
  EXPECT_EQ(model_of<MetallicRoughness>(odd).ior, 1.0F);
  EXPECT_THAT(odd.warnings, ElementsAre(HasSubstr("index of refraction")));
}

TEST_F(GltfTest, UnlitMaterialsAreTheirBaseColor) {
  const LoadedScene scene = load(material_gltf({{"emissiveFactor", {1, 1, 1}},
                                                {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0, 1}}}},
                                                {"extensions", {{"KHR_materials_unlit", json::object()}}}}));
  EXPECT_EQ(model_of<Unlit>(scene).color, vec3(0.5F, 0.25F, 0));
  EXPECT_EQ(scene.materials.at(0).emissive, vec3(0)) << "KHR_materials_unlit ignores all but the base colour";
}

TEST_F(GltfTest, WithoutAMaterialTheDefaultOneHolds) {
  GltfBuilder gltf = material_gltf({{"name", "other"}});
  gltf.show(gltf.json["meshes"][0]["primitives"][0]);
  gltf.json["meshes"][1]["primitives"][0].erase("material");
  const LoadedScene scene = load(gltf);
  EXPECT_EQ(scene.objects[0].material, 0U);
  EXPECT_EQ(scene.objects[1].material, 1U);
  const auto& model = std::get<MetallicRoughness>(scene.materials.at(1).model);
  EXPECT_EQ(model.base_color * model.metallic, vec3(1)) << "the default is a white metal";
}

TEST_F(GltfTest, WhatMaterialsLoseIsSaid) {
  GltfBuilder gltf = material_gltf({{"name", "film"}, {"extensions", {{"VENDOR_materials_film", json::object()}}}});
  gltf.json["extensionsUsed"] = {"VENDOR_materials_film", "KHR_texture_transform"};
  gltf.add_node({{"mesh", 0}});
  EXPECT_THAT(load(gltf).warnings, ElementsAre("1 material uses VENDOR_materials_film, which is not known; it is "
                                               "drawn without it"));
}

TEST_F(GltfTest, GlassIsRead) {
  const LoadedScene scene = load(
      material_gltf({{"extensions",
                      {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}},
                       {"KHR_materials_ior", {{"ior", 1.25}}},
                       {"KHR_materials_volume",
                        {{"thicknessFactor", 2}, {"attenuationColor", {0.5, 0.25, 1}}, {"attenuationDistance", 4}}},
                       {"KHR_materials_dispersion", {{"dispersion", 0.5}}}}}}));
  const auto model = model_of<MetallicRoughness>(scene);
  EXPECT_EQ(model.transmission, 0.75F);
  EXPECT_EQ(model.ior, 1.25F);
  EXPECT_EQ(model.thickness, 2.0F);
  EXPECT_EQ(model.attenuation_color, vec3(0.5F, 0.25F, 1.0F));
  EXPECT_EQ(model.attenuation_distance, 4.0F);
  EXPECT_EQ(model.dispersion, 0.5F);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_FALSE(is_clear(model)) << "the metal of the default lets nothing through";
  const auto bare = model_of<MetallicRoughness>(load(material_gltf(
      {{"extensions", {{"KHR_materials_transmission", json::object()}, {"KHR_materials_volume", json::object()}}}})));
  EXPECT_EQ(bare.transmission, 0.0F);
  EXPECT_EQ(bare.thickness, 0.0F);
  EXPECT_EQ(bare.attenuation_color, vec3(1.0F));
  EXPECT_EQ(bare.dispersion, 0.0F);
  EXPECT_EQ(bare.attenuation_distance, std::numeric_limits<float>::infinity());
}

TEST_F(GltfTest, ClassicGlassIsRead) {
  const LoadedScene scene = load(material_gltf(
      {{"extensions",
        {{"PROMIN_materials_phong", {{"transmissionFactor", {0.5, 0.25, 1}}, {"ior", 1.5}, {"fresnel", true}}}}}}));
  const auto model = model_of<Phong>(scene);
  EXPECT_EQ(model.transmission, vec3(0.5F, 0.25F, 1.0F));
  EXPECT_EQ(model.ior, 1.5F);
  EXPECT_TRUE(model.fresnel);
  EXPECT_TRUE(is_clear(model));
  const auto bare =
      model_of<Phong>(load(material_gltf({{"extensions", {{"PROMIN_materials_phong", json::object()}}}})));
  EXPECT_EQ(bare.transmission, vec3(0.0F));
  EXPECT_EQ(bare.ior, 1.0F);
  EXPECT_FALSE(bare.fresnel);
}

TEST_F(GltfTest, MaterialsHaveAlphaAndSides) {
  const auto material_of = [&](const json& source) {
    GltfBuilder gltf = material_gltf(source);
    gltf.add_node({{"mesh", 0}});
    return load(gltf).materials.at(0);
  };
  const Material plain = material_of(json::object());
  EXPECT_EQ(plain.alpha_mode, AlphaMode::kOpaque);
  EXPECT_FALSE(plain.is_double_sided);
  const json half = {{"baseColorFactor", {1, 1, 1, 0.5}}};
  const Material mask = material_of({{"alphaMode", "MASK"}, {"pbrMetallicRoughness", half}});
  EXPECT_EQ(mask.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(mask.alpha, 0.5F);
  EXPECT_EQ(mask.alpha_cutoff, 0.5F);
  const Material blend = material_of({{"alphaMode", "BLEND"}, {"alphaCutoff", 0.25}, {"doubleSided", true}});
  EXPECT_EQ(blend.alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(blend.alpha, 1.0F);
  EXPECT_EQ(blend.alpha_cutoff, 0.25F);
  EXPECT_TRUE(blend.is_double_sided);
  const Material unlit = material_of({{"alphaMode", "BLEND"},
                                      {"pbrMetallicRoughness", half},
                                      {"extensions", {{"KHR_materials_unlit", json::object()}}}});
  EXPECT_EQ(unlit.alpha, 0.5F);
}

TEST_F(GltfTest, ClassicMaterialsAreOpaqueAndHaveTwoSides) {
  GltfBuilder gltf = material_gltf({{"name", "old"},
                                    {"alphaMode", "BLEND"},
                                    {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}},
                                    {"extensions", {{"PROMIN_materials_phong", json::object()}}}});
  gltf.add_node({{"mesh", 0}});
  const LoadedScene scene = load(gltf);
  EXPECT_EQ(scene.materials.at(0).alpha_mode, AlphaMode::kOpaque);
  EXPECT_TRUE(scene.materials.at(0).is_double_sided);
  EXPECT_THAT(scene.warnings, ElementsAre("material \"old\": its alphaMode is ignored and it is drawn opaque"));
}

TEST_F(GltfTest, PhongMaterialsHaveNoTextures) {
  GltfBuilder gltf = material_gltf({{"name", "old"},
                                    {"normalTexture", {{"index", 0}}},
                                    {"extensions", {{"PROMIN_materials_phong", json::object()}}}});
  gltf.json["images"] = {{{"uri", "missing.png"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  EXPECT_THAT(load(gltf).warnings, ElementsAre("material \"old\": its textures are ignored and its factors are used"));
}

/// A PNG of one pixel with the codes 80 (red), 40 (green) and 20 (blue), all hexadecimal.
const std::string kPixel =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNocFAAAAIkAOGVpLGLAAAAAElFTkSuQmCC";

/// A PNG of one pixel whose green is 0.
const std::string kSmooth =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z/"
    "AfAAQAAf8iCjrwAAAAAElFTkSuQmCC";

/// A file gets one warning for all the properties that promin does not draw.
TEST_F(GltfTest, RoughGlassIsWarnedOfOnce) {
  const json pbr = {{"metallicFactor", 0}, {"roughnessFactor", 0.25}};
  const json extensions = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                           {"KHR_materials_volume", {{"thicknessFactor", 2}}},
                           {"KHR_materials_dispersion", {{"dispersion", 0.5}}}};
  const json frosted = {{"name", "frosted"}, {"pbrMetallicRoughness", pbr}, {"extensions", extensions}};
  const auto warnings_of = [&](const json& changes, const std::string& image = kPixel) {
    json material = frosted;
    material.merge_patch(changes);
    GltfBuilder gltf = material_gltf(material);
    gltf.json["images"] = {{{"uri", image}}};
    gltf.json["textures"] = {{{"source", 0}}};
    return load(gltf).warnings;
  };
  const std::string one = " is rough glass, which blurs only the sky; objects behind it look sharp";
  EXPECT_THAT(warnings_of(json::object()), ElementsAre("material \"frosted\"" + one));
  EXPECT_THAT(warnings_of({{"name", nullptr}}), ElementsAre("material 0" + one));
  const json textured = {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}};
  EXPECT_THAT(warnings_of(textured), ElementsAre(HasSubstr("rough glass")));
  EXPECT_THAT(warnings_of(textured, kSmooth), IsEmpty()) << "no texel is rough";
  EXPECT_THAT(warnings_of({{"pbrMetallicRoughness", {{"roughnessFactor", 0}}}}), IsEmpty());
  EXPECT_THAT(warnings_of({{"pbrMetallicRoughness", {{"metallicFactor", 1}}}}), IsEmpty()) << "nothing goes through";
  EXPECT_THAT(warnings_of({{"extensions", {{"KHR_materials_transmission", nullptr}}}}), IsEmpty());

  GltfBuilder several = material_gltf({{"name", "unseen"}, {"pbrMetallicRoughness", pbr}, {"extensions", extensions}});
  for (int i = 1; i < 4; ++i) {
    several.json["materials"].push_back(frosted);
    several.json["meshes"][0]["primitives"].push_back(several.json["meshes"][0]["primitives"][0]);
  }
  for (int i = 0; i < 4; ++i) several.json["meshes"][0]["primitives"][i]["material"] = std::max(i, 1);
  EXPECT_THAT(load(several).warnings, ElementsAre("material \"frosted\" and 2 others like it are rough glass, which "
                                                  "blurs only the sky; objects behind it look sharp"))
      << "nothing has the first material";
}

TEST_F(GltfTest, TexturesAreTakenAsTheyAre) {
  GltfBuilder gltf =
      material_gltf({{"pbrMetallicRoughness",
                      {{"baseColorTexture",
                        {{"index", 1},
                         {"texCoord", 1},
                         {"extensions",
                          {{"KHR_texture_transform",
                            {{"offset", {0.5, 0.25}}, {"rotation", 1.5707963267948966}, {"scale", {2, 4}}}}}}}},
                       {"metallicRoughnessTexture", {{"index", 0}}}}},
                     {"normalTexture", {{"index", 0}, {"scale", -0.5}}},
                     {"occlusionTexture", {{"index", 0}, {"strength", 0.25}}},
                     {"emissiveTexture", {{"index", 0}}}});
  gltf.json["images"] = {{{"uri", kPixel}, {"name", "pixel"}}};
  gltf.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9985}}};
  gltf.json["textures"] = {{{"source", 0}}, {{"source", 0}, {"sampler", 0}}};
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  const auto model = model_of<MetallicRoughness>(scene);
  const auto texture_of = [&](const TextureSlot& slot) { return scene.textures.at(slot.texture); };
  const auto use_of = [&](const TextureSlot& slot) { return scene.images.at(texture_of(slot).image)->use; };
  EXPECT_EQ(use_of(model.base_color_texture), ImageUse::kColor);
  EXPECT_EQ(use_of(model.metallic_roughness_texture), ImageUse::kData);
  EXPECT_EQ(use_of(model.normal_texture), ImageUse::kNormal);
  EXPECT_EQ(use_of(scene.materials[0].emissive_texture), ImageUse::kColor);
  EXPECT_EQ(scene.images.size(), 3U) << "one for each use";
  EXPECT_EQ(model.normal_scale, -0.5F);
  EXPECT_EQ(model.occlusion_strength, 0.25F);
  EXPECT_EQ(model.base_color_texture.uv_set, 1U);
  expect_near(model.base_color_texture.to_u, {0, 4, 0.5F});
  expect_near(model.base_color_texture.to_v, {-2, 0, 0.25F});
  const Texture texture = texture_of(model.base_color_texture);
  EXPECT_EQ(texture.wrap_u, TextureWrap::kClampToEdge);
  EXPECT_EQ(texture.wrap_v, TextureWrap::kMirroredRepeat);
  EXPECT_FALSE(texture.is_magnified_linearly);
  EXPECT_TRUE(texture.is_minified_linearly);
  EXPECT_TRUE(texture.has_levels);
  EXPECT_FALSE(texture.are_levels_linear);
  EXPECT_TRUE(texture_of(model.normal_texture).are_levels_linear) << "the default";
  EXPECT_EQ(scene.images[0]->name, "pixel");
  EXPECT_EQ(scene.images[0]->texels, std::vector<uint32_t>{0xFF204080});
}

TEST_F(GltfTest, AnImageThatCannotBeReadIsAWarning) {
  GltfBuilder gltf = material_gltf({{"normalTexture", {{"index", 0}}}, {"emissiveTexture", {{"index", 1}}}});
  gltf.json["images"] = {{{"uri", "missing.png"}, {"name", "bumps"}}, {{"uri", "data:;base64,AAAA"}}};
  gltf.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(
      scene.warnings,
      ElementsAre(
          "image \"bumps\": a referenced file does not exist (\"missing.png\"); promin draws materials without it; put "
          "it "
          "beside the scene",
          "image images[1]: a picture cannot be used: its format is unknown; promin draws materials without it; "
          "use another picture"));
  for (const auto& image : scene.images) EXPECT_TRUE(image->texels.empty());
  EXPECT_THAT(message_of([&] { load_scene(folder_ / "scene.gltf", {.is_strict = true}); }),
              testing::AllOf(HasSubstr("a referenced file does not exist"), HasSubstr("format is unknown")));
}

TEST_F(GltfTest, ImagesOfAKindOfFaultShareAWarning) {
  GltfBuilder gltf = material_gltf(
      {{"normalTexture", {{"index", 0}}}, {"emissiveTexture", {{"index", 1}}}, {"occlusionTexture", {{"index", 2}}}});
  gltf.json["images"] = {{{"uri", "a.png"}}, {{"uri", "b.png"}}, {{"uri", "../c.png"}}};
  gltf.json["textures"] = {{{"source", 0}}, {{"source", 1}}, {{"source", 2}}};
  EXPECT_THAT(load(gltf).warnings, UnorderedElementsAre(HasSubstr(", and 1 more; promin"),
                                                        testing::AllOf(HasSubstr("leads out of the scene's folder"),
                                                                       HasSubstr("--root DIR"))));
}

// The next tests check lights and sky.

GltfBuilder light_gltf(const json& light, const json& node = json::object()) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {light};
  json holder = node;
  holder["extensions"]["KHR_lights_punctual"]["light"] = 0;
  gltf.add_node(holder);
  return gltf;
}

TEST_F(GltfTest, SizesOfImagesAreReadWithoutTheirTexels) {
  GltfBuilder gltf = material_gltf({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                    {"normalTexture", {{"index", 1}}},
                                    {"occlusionTexture", {{"index", 2}}}});
  gltf.json["textures"] = {{{"source", 0}}, {{"source", 1}}, {{"source", 2}}};
  gltf.json["images"] = {{{"uri", kPixel}}, {{"uri", "long.png"}}, {{"uri", "broken.png"}}};
  // A text of 100000 bytes lies between the chunk with the size and the pixel.
  std::string bytes;
  const std::optional<std::vector<std::byte>> pixel = decode_base64(kPixel.substr(kPixel.find(',') + 1));
  for (const std::byte byte : *pixel) bytes += static_cast<char>(byte);
  const std::string chunk = std::string("\0\1\x86\xA0tEXt", 8) + std::string(100000, 'x') + std::string(4, '\0');
  write("long.png", bytes.substr(0, 33) + chunk + bytes.substr(33));
  write("broken.png", "no picture");
  const Scene scene = load_scene(write("scene.gltf", gltf.text()), {.decodes_images = false});
  ASSERT_EQ(scene.images.size(), 3U);
  EXPECT_EQ(scene.images[0]->size, uvec2(1));
  EXPECT_EQ(scene.images[1]->size, uvec2(1));
  EXPECT_EQ(scene.images[2]->size, uvec2(0));
  for (const auto& image : scene.images) EXPECT_THAT(image->texels, IsEmpty());
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("image images[2]: ")));
}

TEST_F(GltfTest, PointLightsFallOff) {
  const LoadedScene scene =
      load(light_gltf({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 60}, {"range", 9}, {"name", "key"}},
                      {{"translation", {1, 2, 3}}, {"scale", {7, 7, 7}}}));
  const Light& light = scene.lights.at(0);
  EXPECT_EQ(light.name, "key");
  EXPECT_EQ(light.kind, LightKind::kPoint);
  EXPECT_EQ(light.position, vec3(1, 2, 3));
  EXPECT_EQ(light.diffuse, vec3(60, 30, 0));
  EXPECT_EQ(light.specular, vec3(60, 30, 0));
  EXPECT_EQ(light.attenuation, Attenuation::kInverseSquare);
  EXPECT_EQ(light.range, 9);
}

TEST_F(GltfTest, DirectionalLightsTravelAlongMinusZ) {
  const LoadedScene scene =
      load(light_gltf({{"type", "directional"}, {"intensity", 2}},
                      {{"rotation", {-0.70710678118654752, 0, 0, 0.70710678118654752}}, {"scale", {5, 6, 7}}}));
  const Light& light = scene.lights.at(0);
  EXPECT_EQ(light.kind, LightKind::kDirectional);
  EXPECT_EQ(light.attenuation, Attenuation::kNone);
  EXPECT_EQ(light.diffuse, vec3(2));
  expect_near(light.direction, {0, -1, 0});
}

TEST_F(GltfTest, SpotsHaveCones) {
  const json cone = {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}};
  const LoadedScene scene = load(light_gltf({{"type", "spot"}, {"spot", cone}}));
  EXPECT_EQ(scene.lights.at(0).inner_cone_angle, 0.2F);
  EXPECT_EQ(scene.lights.at(0).outer_cone_angle, 0.4F);
  const LoadedScene plain = load(light_gltf({{"type", "spot"}, {"spot", json::object()}}));
  EXPECT_EQ(plain.lights.at(0).inner_cone_angle, 0.0F);
  EXPECT_FLOAT_EQ(plain.lights.at(0).outer_cone_angle, std::numbers::pi_v<float> / 4);
}

TEST_F(GltfTest, ClassicLightsDoNotFallOffUnlessToldTo) {
  const auto classic = [&](const json& extension) {
    return load(light_gltf({{"type", "point"},
                            {"intensity", 2},
                            {"color", {1, 1, 0}},
                            {"extensions", {{"PROMIN_lights_phong", extension}}}}))
        .lights.at(0);
  };
  EXPECT_EQ(classic(json::object()).attenuation, Attenuation::kNone);
  EXPECT_EQ(classic(json::object()).diffuse, vec3(2, 2, 0));
  EXPECT_EQ(classic(json::object()).specular, vec3(2, 2, 0));
  const Light light =
      classic({{"attenuation", "inverse_square"}, {"diffuseColor", {1, 2, 3}}, {"specularColor", {4, 5, 6}}});
  EXPECT_EQ(light.attenuation, Attenuation::kInverseSquare);
  EXPECT_EQ(light.diffuse, vec3(1, 2, 3));
  EXPECT_EQ(light.specular, vec3(4, 5, 6));
}

TEST_F(GltfTest, LightsHaveSizes) {
  const auto sized = [&](const char* type, const json& extension) {
    return load(
        light_gltf({{"type", type}, {"extensions", {{"PROMIN_lights_size", extension}}}}, {{"scale", {3, 3, 3}}}));
  };
  EXPECT_EQ(sized("point", {{"radius", 0.25}}).lights.at(0).radius, 0.25F) << "a node's scale does not matter";
  EXPECT_EQ(sized("spot", {{"radius", 2}}).lights.at(0).radius, 2.0F);
  EXPECT_EQ(sized("directional", {{"angle", 0.5}}).lights.at(0).angle, 0.5F);
  EXPECT_EQ(sized("point", json::object()).lights.at(0).radius, 0.0F);
  const LoadedScene sun = sized("directional", {{"radius", 1}});
  EXPECT_EQ(sun.lights.at(0).radius, 0.0F);
  EXPECT_THAT(sun.warnings, ElementsAre(HasSubstr("is directional; its radius is ignored")));
  EXPECT_THAT(sized("point", {{"angle", 1}}).warnings, ElementsAre(HasSubstr("its angle is ignored")));
}

// EXT_lights_area is a draft.
TEST_F(GltfTest, FlatLightsAreRead) {
  const auto flat = [&](const json& light, const json& node = json::object()) {
    GltfBuilder gltf = triangle_gltf();
    gltf.json["extensions"]["EXT_lights_area"]["lights"] = {light};
    json holder = node;
    holder["extensions"]["EXT_lights_area"]["light"] = 0;
    gltf.add_node(holder);
    return load(gltf);
  };
  const LoadedScene rect =
      flat({{"type", "rect"}, {"color", {1, 0.5, 0}}, {"intensity", 8}, {"size", 0.5}, {"rect", {{"aspect", 3}}}},
           {{"scale", {2, 1, 1}}, {"translation", {1, 2, 3}}});
  const Light& light = rect.lights.at(0);
  EXPECT_EQ(light.kind, LightKind::kRect);
  EXPECT_EQ(light.position, vec3(1, 2, 3));
  EXPECT_EQ(light.diffuse, vec3(8, 4, 0));
  EXPECT_EQ(light.size, vec2(3, 1)) << "the largest scale multiplies both sides";
  expect_near(light.direction, {0, 0, -1});
  expect_near(light.right, {1, 0, 0});
  EXPECT_EQ(flat({{"type", "disk"}}).lights.at(0).size, vec2(1));
  const LoadedScene wrong = flat({{"type", "rect"}, {"size", -1}});
  EXPECT_THAT(wrong.warnings, ElementsAre(HasSubstr("EXT_lights_area.lights[0].size")));
  EXPECT_THAT(flat({{"type", "tube"}}).warnings, ElementsAre(HasSubstr("promin omits the light")));
  EXPECT_THAT(flat({{"type", "disk"}}, {{"scale", {0, 0, 0}}}).warnings, ElementsAre(HasSubstr("promin omits it")));
}

// Sizes out of range become the nearest that a light can have, with a warning.
TEST_F(GltfTest, WrongSizesOfLightsAreRepaired) {
  const auto sized = [&](const char* type, const json& extension) {
    return load(light_gltf({{"type", type}, {"extensions", {{"PROMIN_lights_size", extension}}}}));
  };
  const LoadedScene ball = sized("point", {{"radius", -1}});
  EXPECT_EQ(ball.lights.at(0).radius, 0.0F);
  EXPECT_THAT(ball.warnings, ElementsAre(HasSubstr("PROMIN_lights_size.radius")));
  const LoadedScene sun = sized("directional", {{"angle", 7}});
  EXPECT_FLOAT_EQ(sun.lights.at(0).angle, std::numbers::pi_v<float>);
  EXPECT_THAT(sun.warnings, ElementsAre(HasSubstr("PROMIN_lights_size.angle")));
  const LoadedScene word = sized("point", {{"radius", "large"}});
  EXPECT_THAT(word.warnings, ElementsAre(HasSubstr("PROMIN_lights_size.radius")));
}

TEST_F(GltfTest, ThePlainSkyIsBackgroundAndAmbientLight) {
  GltfBuilder gltf = triangle_gltf();
  const json plain = {{"color", {0.5, 0.5, 1}}};
  gltf.json["extensions"]["OMI_environment_sky"]["skies"] = {
      {{"type", "plain"}, {"plain", plain}},
      {{"type", "plain"}, {"plain", plain}, {"ambientLightColor", {0, 1, 0}}, {"ambientSkyContribution", 0.5}},
      {{"type", "physical"}, {"ambientLightColor", {0.25, 0.25, 0.25}}, {"ambientSkyContribution", 0}}};
  EXPECT_EQ(load(gltf).environment.background, vec3(0.5F, 0.5F, 1)) << "sky 0 where the scene names none";
  EXPECT_EQ(load(gltf).environment.ambient, vec3(0.5F, 0.5F, 1));
  gltf.json["scenes"] = {{{"nodes", {0}}, {"extensions", {{"OMI_environment_sky", {{"sky", 1}}}}}}};
  EXPECT_EQ(load(gltf).environment.ambient, vec3(0.25F, 0.75F, 0.5F));
  gltf.json["scenes"][0]["extensions"]["OMI_environment_sky"]["sky"] = 2;
  const LoadedScene scene = load(gltf);
  EXPECT_EQ(scene.environment.background, vec3(0));
  EXPECT_EQ(scene.environment.ambient, vec3(0.25F));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("\"physical\"")));
}

TEST_F(GltfTest, GradientSkiesAreRead) {
  GltfBuilder gltf = triangle_gltf();
  auto& skies = gltf.json["extensions"]["OMI_environment_sky"]["skies"];
  skies = {
      {{"type", "gradient"},
       {"gradient",
        {{"topColor", {0, 0, 2}}, {"horizonColor", {1, 1, 1}}, {"bottomColor", {0.5, 0.25, 0}}, {"topCurve", 0.5}}}}};
  LoadedScene scene = load(gltf);
  const auto& sky = std::get<GradientSky>(scene.environment.sky);
  EXPECT_TRUE(scene.environment.shows_sky);
  EXPECT_EQ(sky.top, vec3(0, 0, 2));
  EXPECT_EQ(sky.horizon, vec3(1));
  EXPECT_EQ(sky.bottom, vec3(0.5F, 0.25F, 0));
  EXPECT_EQ(sky.top_curve, 0.5F);
  EXPECT_EQ(sky.bottom_curve, 0.02F) << "as the specification says";
  EXPECT_THAT(scene.warnings, IsEmpty());
  skies[0]["ambientSkyContribution"] = 0.5;
  skies[0]["gradient"]["sunCurve"] = 4;
  EXPECT_THAT(load(gltf).warnings, ElementsAre(HasSubstr("ambientSkyContribution"), HasSubstr("suns")));
  skies[0]["gradient"]["bottomCurve"] = 0;
  EXPECT_THAT(load(gltf).warnings, Contains(HasSubstr("bottomCurve: ")));
  skies[0]["gradient"].erase("bottomCurve");
  skies[0]["gradient"].erase("topColor");
  EXPECT_THAT(load(gltf).warnings, Contains(HasSubstr("\"topColor\" is missing")));
  EXPECT_FALSE(load(gltf).environment.shows_sky);
}

TEST_F(GltfTest, PanoramasLieInTheFileToo) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["extensions"]["OMI_environment_sky"]["skies"] = {
      {{"type", "panorama"}, {"panorama", {{"equirectangular", 0}}}}};
  gltf.json["textures"] = {{{"source", 0}}};
  for (const char* name : {"sky.exr", "sky.png"}) {
    write_image(folder_ / name, {{4, 2}, std::vector<vec3>(8, vec3(0.5F))});
    const std::vector<std::byte> bytes = read_file(folder_ / name);
    const std::string picture(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    gltf.json["images"] = {{{"uri", "data:image/whatever;base64," + encode_base64(picture)}}};
    const LoadedScene in_text = load(gltf);
    EXPECT_THAT(in_text.warnings, IsEmpty());
    // A PNG has 8-bit sRGB values. The value 188 is a linear value of 0.503.
    EXPECT_NEAR(sky_radiance(in_text.environment, dvec3(1, 0, 0)).x, 0.5, 0.004) << name;
    gltf.json["images"] = {{{"mimeType", "image/png"},
                            {"bufferView", gltf.add_view(std::vector<uint8_t>(picture.begin(), picture.end()))}}};
    const LoadedScene in_binary = SceneFolder::load("scene.glb", gltf.glb());
    EXPECT_THAT(in_binary.warnings, IsEmpty());
    EXPECT_NEAR(sky_radiance(in_binary.environment, dvec3(1, 0, 0)).x, 0.5, 0.004) << name;
  }
}

TEST_F(GltfTest, PanoramasLieBesideTheFile) {
  GltfBuilder gltf = triangle_gltf();
  auto& skies = gltf.json["extensions"]["OMI_environment_sky"]["skies"];
  skies = {{{"type", "panorama"}, {"panorama", {{"equirectangular", 1}}}}};
  gltf.json["textures"] = {json::object(), {{"source", 0}}};
  gltf.json["images"] = {{{"uri", "my%20sky.exr"}}};
  EXPECT_THAT(load(gltf).warnings, ElementsAre(HasSubstr("does not exist")));
  write("my sky.exr", "no picture");
  EXPECT_THAT(load(gltf).warnings, ElementsAre(HasSubstr("the picture has an unknown format")));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(load(gltf).environment.sky));
  // The middle of the picture is +Z and its left edge is -Z: the first of four pixels covers -Z to +X.
  Image picture = {{4, 2}, std::vector<vec3>(8, vec3(0.0F))};
  picture.at(0, 0) = picture.at(0, 1) = vec3(1, 0, 0);
  write_image(folder_ / "my sky.exr", picture);
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_TRUE(scene.environment.shows_sky);
  EXPECT_EQ(std::get<Panorama>(scene.environment.sky).image->size, uvec2(4, 2));
  EXPECT_NEAR(sky_radiance(scene.environment, dvec3(1, 0, -1)).x, 1.0, 1e-6);
  EXPECT_NEAR(sky_radiance(scene.environment, dvec3(1, 0, 1)).x, 0.0, 1e-6);
  gltf.json["images"] = {{{"bufferView", 0}}};
  EXPECT_THAT(load(gltf).warnings,
              ElementsAre("the sky's panorama images[0] is ignored: the picture has an unknown format"));
  gltf.json["images"] = {{{"uri", "../sky.exr"}}};
  EXPECT_THAT(load(gltf).warnings, ElementsAre(HasSubstr("leads out of the scene's folder")));
  skies[0]["panorama"] = {{"cubemap", {0, 0, 0, 0, 0, 0}}};
  EXPECT_THAT(load(gltf).warnings, ElementsAre(HasSubstr("cube map")));
  skies[0]["panorama"] = {{"equirectangular", 2}};
  EXPECT_THAT(load(gltf).warnings, Contains(HasSubstr("panorama.equirectangular: ")));
}

// The next tests check cameras.

TEST_F(GltfTest, CamerasComeInNodeOrderWithoutScale) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"aspectRatio", 1.5}, {"znear", 0.25}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0.5}, {"zfar", 9}}}},
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}}}}};
  gltf.add_node({{"camera", 1}, {"name", "side"}, {"rotation", {0, 0.70710678118654752, 0, 0.70710678118654752}}});
  gltf.add_node({{"camera", 0}, {"children", {1}}, {"translation", {1, 2, 3}}, {"scale", {2, 3, 4}}});
  gltf.add_node({{"camera", 2}});
  const LoadedScene scene = load(gltf);
  ASSERT_THAT(scene.cameras, SizeIs(3));
  const Camera& first = scene.cameras[0];
  EXPECT_EQ(first.projection, Projection::kPerspective);
  EXPECT_EQ(first.eye, vec3(1, 2, 3));
  EXPECT_EQ(first.look, vec3(0, 0, -1));
  EXPECT_EQ(first.up, vec3(0, 1, 0));
  EXPECT_EQ(first.yfov, 0.7F);
  EXPECT_EQ(first.aspect_ratio, 1.5F);
  EXPECT_EQ(first.near, 0.25F);
  const Camera& side = scene.cameras[1];
  EXPECT_EQ(side.name, "side");
  EXPECT_EQ(side.projection, Projection::kOrthographic);
  EXPECT_EQ(side.ymag, 2);
  EXPECT_EQ(side.aspect_ratio, 2);
  EXPECT_EQ(side.near, 0.5F);
  expect_near(side.look, {-1, 0, 0});
  expect_near(side.up, {0, 1, 0});
  EXPECT_EQ(scene.cameras[2].near, 0);
  EXPECT_EQ(scene.cameras[2].aspect_ratio, 0);
}

// The next tests check files.

TEST_F(GltfTest, GlbAndTextAreToldApartByTheirBytes) {
  GltfBuilder gltf = triangle_gltf();
  EXPECT_THAT(SceneFolder::load("a.glb", gltf.glb()).objects, SizeIs(1));
  EXPECT_THAT(SceneFolder::load("A.GLTF", gltf.glb()).objects, SizeIs(1));
  EXPECT_THAT(SceneFolder::load("b.glb", gltf.text()).objects, SizeIs(1));
}

TEST_F(GltfTest, BuffersLieBesideTheScene) {
  GltfBuilder gltf = triangle_gltf();
  std::filesystem::create_directories(folder_ / "sub");
  write("sub/my data.bin", gltf.bytes);
  gltf.json["buffers"] = {{{"byteLength", gltf.bytes.size()}, {"uri", "sub/my%20data.bin"}}};
  EXPECT_THAT(SceneFolder::load("a.gltf", gltf.json.dump()).objects, SizeIs(1));
}

/// Returns a document of a triangle with texture coordinates, which nothing reads, in a buffer of their own.
GltfBuilder two_buffer_gltf(const json& second_buffer) {
  GltfBuilder gltf = triangle_gltf();
  gltf.text();
  json& document = gltf.json;
  document["buffers"].push_back({{"byteLength", 24}});
  document["buffers"][1].update(second_buffer);
  document["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 24}});
  document["accessors"].push_back(
      {{"bufferView", document["bufferViews"].size() - 1}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
  document["meshes"][0]["primitives"][0]["attributes"]["_MINE"] = document["accessors"].size() - 1;
  return gltf;
}

TEST_F(GltfTest, BuffersThatNoMeshNeedsMayLackBytes) {
  write("whole.bin", std::string(24, 'x'));
  write("short.bin", "1234");
  write("empty.bin", "");
  const auto warnings_of = [&](const json& second_buffer) {
    const LoadedScene scene = SceneFolder::load("a.gltf", two_buffer_gltf(second_buffer).json.dump());
    EXPECT_EQ(corners_of(mesh_of(scene)), (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    return scene.warnings;
  };
  const auto lack = [](int size) {
    return ElementsAre("buffers[1] has " + std::to_string(size) +
                       " bytes, fewer than its byteLength of 24; no mesh needs it");
  };
  EXPECT_THAT(warnings_of({{"uri", "whole.bin"}}), IsEmpty());
  EXPECT_THAT(warnings_of({{"uri", "none.bin"}}), lack(0));
  EXPECT_THAT(warnings_of({{"uri", "short.bin"}}), lack(4));
  EXPECT_THAT(warnings_of({{"uri", "empty.bin"}}), lack(0));
  EXPECT_THAT(warnings_of({{"uri", "data:application/octet-stream;base64,AAAA"}}), lack(3));
  EXPECT_THAT(warnings_of(json::object()), lack(0));
}

TEST_F(GltfTest, BytesAfterTheEndOfAGlbAreIgnored) {
  GltfBuilder gltf = triangle_gltf();
  const LoadedScene scene = SceneFolder::load("a.glb", gltf.glb() + "more");
  EXPECT_EQ(corners_of(mesh_of(scene)), (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_THAT(scene.warnings, ElementsAre("the 4 bytes after the end of the GLB are ignored"));
}

TEST_F(GltfTest, ImagesAreNotTouched) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["images"] = {{{"uri", "missing.png"}}};
  EXPECT_THAT(load(gltf).warnings, IsEmpty());
}

TEST_F(GltfTest, UnusedSkinsAndTargetsChangeNothing) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["animations"] = {{{"channels", json::array()}, {"samplers", json::array()}}};
  gltf.json["skins"] = {{{"joints", {0}}}, {{"joints", {0}}}};
  gltf.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(corners_of(mesh_of(scene)), (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST_F(GltfTest, MorphTargetsHaveTheirDefaultWeights) {
  GltfBuilder gltf = triangle_gltf();
  auto& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = gltf.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const size_t up = gltf.add<float>({0, 0, 0, 0, 0, 2, 0, 0, 0}, "VEC3");
  const size_t aside = gltf.add<float>({0, 0, 0, 0, 0, 0, 4, 0, 0}, "VEC3");
  primitive["targets"] = {{{"POSITION", up}, {"NORMAL", up}}, {{"POSITION", aside}}};
  gltf.json["meshes"][0]["weights"] = {0.5, 0.25};
  gltf.add_node({{"mesh", 0}, {"weights", {0, 1}}});
  gltf.add_node({{"mesh", 0}, {"weights", {0.5, 0.25}}});
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(mesh_of(scene, 0).positions, ElementsAre(vec3(0), vec3(1, 0, 1), vec3(1, 1, 0)));
  EXPECT_THAT(mesh_of(scene, 0).normals, ElementsAre(vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 0, 1)));
  EXPECT_THAT(mesh_of(scene, 1).positions, ElementsAre(vec3(0), vec3(1, 0, 0), vec3(4, 1, 0)));
  EXPECT_EQ(mesh_of(scene, 2).positions, mesh_of(scene, 0).positions);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(GltfTest, MorphTargetsWithoutWeightsNeedNoBytes) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 1}}};
  EXPECT_EQ(mesh_of(load(gltf)).positions.size(), 3U);
  gltf.json["meshes"][0]["weights"] = {1};
  EXPECT_THAT(load(gltf).warnings, Contains(HasSubstr("a morph target has a different number of vertices")));
}

TEST_F(GltfTest, IntegersMayBeWrittenAsFloats) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["accessors"][0]["count"] = 3.0;
  EXPECT_THAT(load(gltf).objects, SizeIs(1));
}

}  // namespace
}  // namespace promin
