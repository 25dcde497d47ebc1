// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/rich_gltf.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const float kNotANumber = std::numeric_limits<float>::quiet_NaN();
const std::vector<vec3> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// A change that makes a document faulty without making its geometry ambiguous, and the warning that it causes.
struct GltfRepair {
  const char* name;
  std::function<void(GltfBuilder&)> spoil;
  const char* warning;
};

std::ostream& operator<<(std::ostream& stream, const GltfRepair& repair) {
  return stream << repair.name;
}

class GltfRepairTest : public SceneFolder {
 protected:
  LoadedScene load(GltfBuilder& gltf) const { return SceneFolder::load("scene.gltf", gltf.text()); }

  /// Returns the refusal of a strict loader.
  std::string strict_refusal(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path file = write(name, bytes);
    return message_of([&] { load_scene(file, {.is_strict = true}); });
  }
};

class GltfRepairsTest : public GltfRepairTest, public testing::WithParamInterface<GltfRepair> {};

TEST_P(GltfRepairsTest, AreOneWarningAndStrictlyARefusal) {
  GltfBuilder gltf = rich_gltf();
  ASSERT_EQ(strict_refusal("good.gltf", gltf.text()), "");
  GetParam().spoil(gltf);
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings, ElementsAre(GetParam().warning));
  ASSERT_GE(scene.objects.size(), 3U);
  for (const world::Object& object : scene.objects) {
    EXPECT_FALSE(std::holds_alternative<world::NotDrawn>(object.shape)) << "the geometry is all there";
  }
  EXPECT_THAT(strict_refusal("bad.gltf", gltf.text()), HasSubstr("; ")) << "no cure";
}

/// Returns the text of a file whose material has this number as its metallic factor. The number may have any length.
std::string with_metallic_factor(const std::string& number) {
  GltfBuilder gltf = rich_gltf();
  gltf.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = "NUMBER";
  gltf.json["extras"] = R"(a "1e999" in a string \\ stays)";
  std::string text = gltf.text();
  return text.replace(text.find("\"NUMBER\""), 8, number);
}

TEST_F(GltfRepairTest, NumbersBeyondDoubleAreOutOfRange) {
  for (const std::string& number : {std::string("1e999"), std::string("123456789e400"), "1" + std::string(400, '0')}) {
    const LoadedScene scene = SceneFolder::load("scene.gltf", with_metallic_factor(number));
    EXPECT_THAT(scene.warnings, ElementsAre("materials[0].pbrMetallicRoughness.metallicFactor: a number is out of "
                                            "range (1.7976931348623157e+308); it is clamped to 0 to 1"))
        << number;
  }
  EXPECT_THAT(SceneFolder::load("scene.gltf", with_metallic_factor("-1e999")).warnings,
              ElementsAre(HasSubstr("out of range (-1.7976931348623157e+308)")));
  EXPECT_THAT(SceneFolder::load("scene.gltf", with_metallic_factor("1e-999")).warnings, IsEmpty());
  EXPECT_THAT(strict_refusal("strict.gltf", with_metallic_factor("1e999")), HasSubstr("is out of range"));
}

#define PROMIN_CLAMPED(VALUE, PLACE, RANGE) PLACE ": a number is out of range (" VALUE "); it is clamped to " RANGE
#define PROMIN_LIGHT "extensions.KHR_lights_punctual.lights[0]"

const GltfRepair kGltfRepairs[] = {
    // The next rows are faults of the document.
    {"NoAsset", [](auto& g) { g.json.erase("asset"); },
     "asset.version: the version is missing; promin reads the file as glTF 2.0"},
    {"VersionIsANumber", [](auto& g) { g.json["asset"]["version"] = 2; },
     "asset.version: the version does not have the form that glTF requires (2); promin reads the file as glTF 2.0"},
    {"SceneIndex", [](auto& g) { g.json["scene"] = 0; },
     "scene: an index is out of range (index 0); promin ignores it"},
    {"NameIsNumber", [](auto& g) { shape(g, 0)["name"] = 7; },
     "extensions.KHR_implicit_shapes.shapes[0].name: another value is given where a string is expected (7); promin "
     "ignores it"},
    {"ExtensionsUsed",
     [](auto& g) {
       g.json["extensionsUsed"] = {"KHR_materials_ior", 3};
     },
     "extensionsUsed[1]: another value is given where a string is expected (3); promin ignores the object that "
     "contains it"},
    // The next rows are faults of materials.
    {"MaterialIndex", [](auto& g) { primitive(g)["material"] = 1; },
     "meshes[0].primitives[0].material: an index is out of range (index 1); promin ignores it"},
    {"MaterialIsNoObject", [](auto& g) { g.json["materials"][0] = "red"; },
     "materials[0]: another value is given where an object is expected (a JSON string); promin ignores it"},
    {"MaterialsIsNoArray", [](auto& g) { g.json["materials"] = 1; },
     "materials: another value is given where an array is expected (1); promin ignores it"},
    {"Metallic", [](auto& g) { g.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 2; },
     PROMIN_CLAMPED("2", "materials[0].pbrMetallicRoughness.metallicFactor", "0 to 1")},
    {"MetallicIsText", [](auto& g) { g.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = "1"; },
     "materials[0].pbrMetallicRoughness.metallicFactor: another value is given where a number is expected (a JSON "
     "string); promin ignores it"},
    {"BaseColor",
     [](auto& g) {
       g.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1.5, 1, 1};
     },
     PROMIN_CLAMPED("1.5", "materials[0].pbrMetallicRoughness.baseColorFactor[1]", "0 to 1")},
    {"Emission",
     [](auto& g) {
       g.json["materials"][0]["emissiveFactor"] = {7, -1, 0};
     },
     PROMIN_CLAMPED("-1", "materials[0].emissiveFactor[1]", "0 to 1e+15")},
    {"AlphaMode", [](auto& g) { g.json["materials"][0]["alphaMode"] = "CUTOUT"; },
     "materials[0].alphaMode: a value is not one of OPAQUE|MASK|BLEND (\"CUTOUT\"); promin ignores it"},
    {"Ior",
     [](auto& g) {
       material_extension(g, "KHR_materials_ior") = {{"ior", -1}};
     },
     "materials[0].extensions.KHR_materials_ior.ior: a number is out of range (-1); promin ignores it"},
    {"PhongIor",
     [](auto& g) {
       material_extension(g, "PROMIN_materials_phong") = {{"ior", 0}};
     },
     "materials[0].extensions.PROMIN_materials_phong.ior: a number is out of range (0); promin ignores it"},
    {"Transmission",
     [](auto& g) {
       material_extension(g, "KHR_materials_transmission") = {{"transmissionFactor", 2}};
     },
     PROMIN_CLAMPED("2", "materials[0].extensions.KHR_materials_transmission.transmissionFactor", "0 to 1")},
    {"AttenuationDistance",
     [](auto& g) {
       material_extension(g, "KHR_materials_volume") = {{"attenuationDistance", -1}};
     },
     "materials[0].extensions.KHR_materials_volume.attenuationDistance: a number is out of range (-1); promin ignores "
     "it"},
    {"AttenuationColor",
     [](auto& g) {
       material_extension(g, "KHR_materials_volume") = {{"attenuationColor", {1, -1, 1}}};
     },
     PROMIN_CLAMPED("-1", "materials[0].extensions.KHR_materials_volume.attenuationColor[1]", "0 to 1")},
    {"Dispersion",
     [](auto& g) {
       material_extension(g, "KHR_materials_dispersion") = {{"dispersion", -1}};
     },
     PROMIN_CLAMPED("-1", "materials[0].extensions.KHR_materials_dispersion.dispersion", "0 to 1e+15")},
    {"Specular",
     [](auto& g) {
       material_extension(g, "KHR_materials_specular") = {{"specularFactor", 2}};
     },
     PROMIN_CLAMPED("2", "materials[0].extensions.KHR_materials_specular.specularFactor", "0 to 1")},
    {"SpecularColor",
     [](auto& g) {
       material_extension(g, "KHR_materials_specular") = {{"specularColorFactor", {1, -1, 1}}};
     },
     PROMIN_CLAMPED("-1", "materials[0].extensions.KHR_materials_specular.specularColorFactor[1]", "0 to 1e+15")},
    {"TextureIndex",
     [](auto& g) {
       g.json["materials"][0]["normalTexture"] = {{"index", 0}};
     },
     "materials[0].normalTexture.index: an index is out of range (index 0); promin omits the texture"},
    {"TextureWithoutIndex",
     [](auto& g) {
       g.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"texCoord", 0}};
     },
     "materials[0].pbrMetallicRoughness.baseColorTexture: \"index\" is missing; promin omits the texture"},
    {"SamplerFilter",
     [](auto& g) {
       g.json["samplers"] = {{{"magFilter", 9987}}};
     },
     "samplers[0].magFilter: a value is not one of 9728|9729 (\"9987\"); promin ignores it"},
    {"SamplerIndex",
     [](auto& g) {
       g.json["textures"] = {{{"sampler", 4}}};
     },
     "textures[0].sampler: an index is out of range (index 4); promin ignores it"},
    {"ImageView",
     [](auto& g) {
       g.json["images"] = {{{"bufferView", 99}, {"mimeType", "image/png"}}};
     },
     "images[0].bufferView: an index is out of range (index 99); promin ignores it"},
    {"ImageViewPastItsBuffer",
     [](auto& g) {
       g.json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 52}});
       g.json["images"] = {{{"bufferView", 2}, {"mimeType", "image/png"}}};
     },
     "images[0]: the buffer view of an image extends beyond its buffer (10 bytes); promin omits the image"},
    // The next rows are faults of lights and cameras.
    {"LightIndex", [](auto& g) { g.json["nodes"][3]["extensions"]["KHR_lights_punctual"]["light"] = 1; },
     "nodes[3].extensions.KHR_lights_punctual.light: an index is out of range (index 1); promin omits the light"},
    {"NegativePower", [](auto& g) { light(g)["intensity"] = -1; },
     PROMIN_CLAMPED("-1", PROMIN_LIGHT ".intensity", "0 to 1e+15")},
    {"LightType", [](auto& g) { light(g)["type"] = "area"; },
     PROMIN_LIGHT ".type: a value is not one of point|directional|spot (\"area\"); promin omits the light"},
    {"LightRange", [](auto& g) { light(g)["range"] = 0; },
     PROMIN_LIGHT ".range: a number is out of range (0); promin ignores it"},
    {"ConeAngles",
     [](auto& g) {
       light(g)["spot"] = {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}};
     },
     PROMIN_LIGHT ".spot: a spot's inner cone angle is not less than its outer cone angle; its edge is sharp"},
    {"CameraIndex", [](auto& g) { g.json["nodes"][3]["camera"] = 1; },
     "nodes[3].camera: an index is out of range (index 1); promin ignores it"},
    {"FieldOfView", [](auto& g) { g.json["cameras"][0]["perspective"]["yfov"] = 3.2; },
     "cameras[0].perspective.yfov: a number is out of range (3.2); promin omits the camera"},
    {"NoFieldOfView", [](auto& g) { g.json["cameras"][0]["perspective"] = json::object(); },
     "cameras[0].perspective: \"yfov\" is missing; promin omits the camera"},
    {"AspectRatio", [](auto& g) { g.json["cameras"][0]["perspective"]["aspectRatio"] = 0; },
     "cameras[0].perspective.aspectRatio: a number is out of range (0); promin ignores it"},
    {"CameraType", [](auto& g) { g.json["cameras"][0]["type"] = "fisheye"; },
     "cameras[0].type: a value is not one of perspective|orthographic (\"fisheye\"); promin omits the camera"},
    {"CameraWithoutParameters", [](auto& g) { g.json["cameras"][0].erase("perspective"); },
     "cameras[0]: the camera's parameters are missing; promin omits the camera"},
    {"Sky",
     [](auto& g) {
       g.json["extensions"]["OMI_environment_sky"]["skies"] = {{{"type", 3}}};
     },
     "extensions.OMI_environment_sky.skies[0].type: another value is given where a string is expected (3); promin "
     "ignores the object that contains it"},
    // The next rows are faults of vertices.
    {"NegativeColor",
     [](auto& g) {
       primitive(g)["attributes"]["COLOR_0"] = g.template add<float>({0, 0, 0, 0, -1, 0, 0, 0, 0}, "VEC3");
     },
     "meshes[0].primitives[0].attributes.COLOR_0, element 1: a vertex colour is negative or not a number (-1.000000); "
     "0 is used for a negative value, 1 for one that is not a number"},
    {"NanColors",
     [](auto& g) {
       primitive(g)["attributes"]["COLOR_0"] =
           g.template add<float>({0, kNotANumber, 0, 0, 0, 0, kNotANumber, 0, 0}, "VEC3");
     },
     "meshes[0].primitives[0].attributes.COLOR_0, element 0: a vertex colour is negative or not a number (nan), and 1 "
     "more; 0 is used for a negative value, 1 for one that is not a number"},
    {"NanTextureCoordinate",
     [](auto& g) {
       primitive(g)["attributes"]["TEXCOORD_0"] = g.template add<float>({0, 0, 1, kNotANumber, 0, 1}, "VEC2");
     },
     "meshes[0].primitives[0].attributes.TEXCOORD_0, element 1: a texture coordinate is beyond 1e15 or not finite "
     "(nan); 0 is used"},
    {"AttributeCounts",
     [](auto& g) {
       primitive(g)["attributes"]["NORMAL"] = g.template add<float>({0, 0, 1}, "VEC3");
     },
     "meshes[0].primitives[0].attributes.NORMAL: an attribute does not have one element for each vertex "
     "(1 for 3 vertices); promin omits the attribute"},
    {"AttributeFormat",
     [](auto& g) {
       primitive(g)["attributes"]["TEXCOORD_0"] = g.template add<float>({0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
     },
     "meshes[0].primitives[0].attributes.TEXCOORD_0: the format of an attribute is not allowed (VEC3 of 5126); promin "
     "omits the attribute"},
    {"NormalizedIndices", [](auto& g) { g.json["accessors"][1]["normalized"] = true; },
     "meshes[0].primitives[0].indices: the indices are normalized; they are read as integers"},
    {"OddStride",
     [](auto& g) {
       g.json["bufferViews"][0]["byteStride"] = 14;
       g.json["bufferViews"][0]["byteLength"] = 40;
     },
     "bufferViews[0].byteStride: a stride is not a multiple of 4 from 4 to 252 (14); promin uses it as it is"},
    {"NoStride", [](auto& g) { g.json["bufferViews"][0]["byteStride"] = 0; },
     "bufferViews[0].byteStride: a stride is not a multiple of 4 from 4 to 252 (0); promin reads the elements without "
     "a stride"},
    // The next rows are faults of nodes.
    {"TwoParents",
     [](auto& g) {
       g.json["nodes"][0]["children"] = {2};
       g.json["nodes"][1]["children"] = {2};
     },
     "nodes[1].children[0]: a node has two parents (nodes[2]); it appears below both"},
    {"ChildTwice",
     [](auto& g) {
       g.json["nodes"][0]["children"] = {2, 2};
     },
     "nodes[0].children[1]: a node lists a child twice (nodes[2]); it is shown once"},
    {"ChildAsRoot",
     [](auto& g) {
       g.json["nodes"][3]["children"] = {1};
       g.json["scenes"] = {{{"nodes", {0, 1, 2}}}};
     },
     "scenes[0].nodes[1]: a scene lists a node that has a parent (nodes[1]); it is shown as a root, without the "
     "parent's transform"},
    {"ChildBesideItsParent",
     [](auto& g) {
       g.json["nodes"][0]["children"] = {1};
       g.json["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
     },
     "scenes[0].nodes[1]: a scene lists a node that lies below another (nodes[1]); it is shown once, below that node"},
    {"RootTwice",
     [](auto& g) {
       g.json["scenes"] = {{{"nodes", {0, 1, 0, 2}}}};
     },
     "scenes[0].nodes[2]: a scene lists a node twice (nodes[0]); it is shown once"},
    {"MatrixAndScale",
     [](auto& g) {
       g.json["nodes"][0].update({{"scale", {1, 1, 1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
     },
     "nodes[0]: a node has both a matrix and a translation, rotation or scale; the matrix is used"},
    {"PerspectiveMatrix",
     [](auto& g) { g.json["nodes"][0]["matrix"] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     "nodes[0].matrix[3]: the matrix is not affine (0.5); its last row is read as 0 0 0 1"},
    {"ZeroRotation",
     [](auto& g) {
       g.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     "nodes[0].rotation: a rotation has length 0; the node is not turned"},
};

INSTANTIATE_TEST_SUITE_P(Table, GltfRepairsTest, testing::ValuesIn(kGltfRepairs),
                         [](const auto& repair) { return std::string(repair.param.name); });

// The next tests check numbers with rounding errors.

TEST_F(GltfRepairTest, RoundedFactorsAreClampedInSilence) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["materials"] = {{{"pbrMetallicRoughness",
                              {{"metallicFactor", 1.0009},
                               {"roughnessFactor", -1e-9},
                               {"baseColorFactor", {1.00016, 0.5, -0.0009, 1.0000001}}}},
                             {"emissiveFactor", {2, -1e-8, 1}},
                             {"occlusionTexture", {{"index", 0}, {"strength", 1.0000001}}}}};
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["images"] = {{{"uri", "data:image/png;base64,"}}};
  primitive(gltf)["material"] = 0;
  const std::filesystem::path file = write("scene.gltf", gltf.text());
  const Scene scene = load_scene(file, {.decodes_images = false});
  for (const std::string& warning : scene.warnings) EXPECT_THAT(warning, HasSubstr("image"));
  const auto& model = std::get<MetallicRoughness>(scene.materials[0].model);
  EXPECT_EQ(model.metallic, 1.0F);
  EXPECT_EQ(model.roughness, 0.0F);
  EXPECT_EQ(model.base_color, vec3(1, 0.5F, 0));
  EXPECT_EQ(scene.materials[0].alpha, 1.0F);
  EXPECT_EQ(scene.materials[0].emissive, vec3(2, 0, 1)) << "light may exceed 1";
  EXPECT_EQ(model.occlusion_strength, 1.0F);
  EXPECT_THAT(strict_refusal("strict.gltf", gltf.text()), HasSubstr("metallicFactor"));
}

TEST_F(GltfRepairTest, RoundedMatricesAreAffine) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["nodes"][0]["matrix"] = {1, 0, 0, 1e-8, 0, 1, 0, -0.0009, 0, 0, 1, 0, 3, 0, 0, 0.9999999};
  LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(corners_of(mesh_of(scene)), ElementsAre(vec3(3, 0, 0), vec3(4, 0, 0), vec3(3, 1, 0)));
  EXPECT_THAT(strict_refusal("strict.gltf", gltf.text()), HasProblem("gltf.matrix.affine"));
  gltf.json["nodes"][0]["matrix"][15] = 0.5;
  scene = load(gltf);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("nodes[0].matrix[15]: the matrix is not affine (0.5)")));
  EXPECT_THAT(corners_of(mesh_of(scene))[1], vec3(4, 0, 0));
}

// The next tests check faults of nodes.

TEST_F(GltfRepairTest, AListedNodeIsARootWhereItsParentIsInNoScene) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["nodes"][0]["translation"] = {0, 0, 2};
  gltf.add_node({{"children", {0}}, {"translation", {5, 0, 0}}, {"scale", {3, 3, 3}}});
  gltf.json["scenes"] = {{{"nodes", {0}}}};
  LoadedScene scene = load(gltf);
  ASSERT_THAT(scene.objects, SizeIs(1));
  EXPECT_THAT(corners_of(mesh_of(scene)), ElementsAre(vec3(0, 0, 2), vec3(1, 0, 2), vec3(0, 1, 2)));
  EXPECT_THAT(scene.warnings, SizeIs(1));

  gltf.json["scenes"] = {{{"nodes", {0, 1}}}};
  scene = load(gltf);
  ASSERT_THAT(scene.objects, SizeIs(1)) << "it is shown once, by its parent's transform";
  EXPECT_THAT(corners_of(mesh_of(scene)), ElementsAre(vec3(5, 0, 6), vec3(8, 0, 6), vec3(5, 3, 6)));
}

TEST_F(GltfRepairTest, ManyListedNodesAreOneWarning) {
  GltfBuilder gltf = triangle_gltf();
  json listed = json::array();
  for (int i = 0; i < 100; ++i) {
    const size_t node = gltf.add_node({{"mesh", 0}});
    gltf.add_node({{"children", {node}}});
    listed.push_back(node);
  }
  gltf.json["scenes"] = {{{"nodes", listed}}};
  EXPECT_THAT(load(gltf).warnings, ElementsAre(HasSubstr(", and 99 more; it is shown as a root")));
}

TEST_F(GltfRepairTest, ANodeOfTwoParentsIsShownBelowEach) {
  GltfBuilder gltf = triangle_gltf();
  gltf.add_node({{"children", {0}}, {"translation", {1, 0, 0}}});
  gltf.add_node({{"children", {0}}, {"translation", {2, 0, 0}}});
  const LoadedScene scene = load(gltf);
  ASSERT_THAT(scene.objects, SizeIs(2));
  EXPECT_EQ(corners_of(mesh_of(scene, 0))[0], vec3(1, 0, 0));
  EXPECT_EQ(corners_of(mesh_of(scene, 1))[0], vec3(2, 0, 0));
}

TEST_F(GltfRepairTest, NodesOfManyParentsEndInARefusal) {
  GltfBuilder gltf = triangle_gltf();
  for (int i = 0; i < 64; ++i) {
    const size_t below = gltf.json["nodes"].size() - 1;
    gltf.add_node({{"children", {below}}});
    gltf.add_node({{"children", {below, below + 1}}});
  }
  EXPECT_THAT(refusal("scene.gltf", gltf.text()), HasProblem("gltf.node.parents"));
}

TEST_F(GltfRepairTest, TheMatrixCountsAlone) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["nodes"][0] = {{"mesh", 0},
                           {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1}},
                           {"translation", {7, 0, 0}},
                           {"rotation", {0, 0, 0, 0}},
                           {"scale", {2, 2, 2}}};
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(corners_of(mesh_of(scene)), ElementsAre(vec3(0, 0, 3), vec3(1, 0, 3), vec3(0, 1, 3)));
  EXPECT_THAT(scene.warnings, SizeIs(1));
}

// The next tests check scales of 0.

TEST_F(GltfRepairTest, NodesOfScaleZeroAreNotDrawnAndKeepTheirNumber) {
  GltfBuilder gltf = rich_gltf();
  gltf.add_node({{"mesh", 0}, {"name", "last"}});
  // The mesh and both shapes are under scales of 0 along three axes and along two.
  gltf.json["nodes"][0]["scale"] = {0, 0, 0};
  gltf.json["nodes"][1]["scale"] = {0, 2, 0};
  gltf.json["nodes"][2]["matrix"] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  const LoadedScene scene = load(gltf);
  ASSERT_THAT(scene.objects, SizeIs(4));
  for (size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::holds_alternative<world::NotDrawn>(scene.objects[i].shape)) << i;
  EXPECT_EQ(corners_of(mesh_of(scene, 3)), kCorners);
  EXPECT_THAT(scene.warnings, IsEmpty()) << "the format allows it";
  EXPECT_EQ(strict_refusal("strict.gltf", gltf.text()), "");
}

TEST_F(GltfRepairTest, AMeshOfScaleZeroAlongOneAxisIsFlat) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["nodes"][0]["scale"] = {2, 3, 0};
  EXPECT_THAT(corners_of(mesh_of(load(gltf))), ElementsAre(vec3(0), vec3(2, 0, 0), vec3(0, 3, 0)));
}

TEST_F(GltfRepairTest, AllHiddenIsASceneOfNothing) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["nodes"][0]["scale"] = {0, 0, 0};
  EXPECT_THAT(load(gltf).warnings, ElementsAre(HasSubstr("nothing to draw")));
}

TEST_F(GltfRepairTest, CamerasAndLightsBelowScaleZeroTurnByRotations) {
  const double half = std::sqrt(0.5);
  GltfBuilder gltf = rich_gltf();
  gltf.json["nodes"][3]["translation"] = {1, 2, 3};
  gltf.json["nodes"][3]["rotation"] = {0, half, 0, half};
  gltf.add_node({{"children", {3}}, {"scale", {0, 0, 0}}, {"rotation", {half, 0, 0, half}}});
  LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.cameras, SizeIs(1));
  ASSERT_THAT(scene.lights, SizeIs(1));
  // The rotation about Y turns -Z to -X, which the rotation about X keeps; that rotation turns +Y to +Z.
  EXPECT_LT(glm::distance(scene.cameras[0].look, vec3(-1, 0, 0)), 1e-6F);
  EXPECT_LT(glm::distance(scene.cameras[0].up, vec3(0, 0, 1)), 1e-6F);
  EXPECT_LT(glm::distance(scene.lights[0].direction, vec3(-1, 0, 0)), 1e-6F);
  EXPECT_EQ(scene.cameras[0].eye, vec3(0)) << "the scale of 0 moves it";

  gltf.json["nodes"][4]["scale"] = {1, 1, 0};
  EXPECT_LT(glm::distance(load(gltf).cameras.at(0).look, vec3(-1, 0, 0)), 1e-6F);

  gltf.json["nodes"][4] = {{"children", {3}}, {"matrix", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}}};
  scene = load(gltf);
  EXPECT_THAT(scene.cameras, IsEmpty());
  EXPECT_THAT(scene.lights, IsEmpty());
  EXPECT_THAT(scene.warnings, ElementsAre("nodes[3]: a camera has no orientation; promin omits it",
                                          "nodes[3]: a light has no direction; promin omits it"));
}

TEST_F(GltfRepairTest, PointLightsBelowScaleZeroStay) {
  GltfBuilder gltf = rich_gltf();
  light(gltf) = {{"type", "point"}};
  gltf.json["nodes"][3].erase("camera");
  gltf.json["nodes"][3]["matrix"] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 1};
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(scene.lights.at(0).position, vec3(1, 2, 3));
}

TEST_F(GltfRepairTest, CamerasAndLightsTooFarAwayAreLeftOut) {
  GltfBuilder gltf = rich_gltf();
  gltf.json["nodes"][3]["translation"] = {1e15, 0, 0};
  gltf.add_node({{"children", {3}}, {"scale", {2, 2, 2}}});
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings, ElementsAre("nodes[3]: a camera lies beyond 1e15 in the world; promin omits it",
                                          "nodes[3]: a light lies beyond 1e15 in the world; promin omits it"));
  EXPECT_THAT(scene.objects, SizeIs(3));
}

TEST_F(GltfRepairTest, RangesOfLightsMayBeTheLargestFloat) {
  GltfBuilder gltf = rich_gltf();
  light(gltf)["range"] = 3.4028234663852886e38;
  material_extension(gltf, "KHR_materials_volume") = {{"attenuationDistance", 3.4028234663852886e38}};
  EXPECT_THAT(load(gltf).warnings, IsEmpty());
  EXPECT_TRUE(std::isinf(load(gltf).lights.at(0).range));
}

TEST_F(GltfRepairTest, TheDraftOfLightsIsRead) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["extensionsUsed"] = {"KHR_lights"};
  gltf.json["extensions"]["KHR_lights"]["lights"] = {
      {{"type", "ambient"}, {"color", {1, 1, 1}}},
      {{"type", "spot"}, {"color", {1, 0.5, 0}}, {"intensity", 3}, {"spot", {{"outerConeAngle", 0.5}}}}};
  gltf.json["scenes"] = {{{"nodes", {0, 1}}, {"extensions", {{"KHR_lights", {{"light", 0}}}}}}};
  gltf.add_node({{"translation", {1, 2, 3}}, {"extensions", {{"KHR_lights", {{"light", 1}}}}}});
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("\"ambient\"")));
  ASSERT_THAT(scene.lights, SizeIs(1));
  EXPECT_EQ(scene.lights[0].kind, LightKind::kSpot);
  EXPECT_EQ(scene.lights[0].position, vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[0].diffuse, vec3(3, 1.5F, 0));
  EXPECT_EQ(scene.lights[0].outer_cone_angle, 0.5F);
}

// The next tests check faults of bytes.

TEST_F(GltfRepairTest, DataUrisHaveManyForms) {
  GltfBuilder gltf = triangle_gltf();
  gltf.text();
  const std::string base64 = encode_base64(gltf.bytes + "\xff\xfe");
  ASSERT_NE(base64.find('/'), std::string::npos);
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = base64;
    for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
    return text;
  };
  for (const std::string& uri :
       {"DATA:application/octet-stream;base64," + base64, "data:;base64," + base64,
        "Data:model/x;charset=utf-8;Base64," + base64, "data:application/gltf-buffer;base64," + replaced("=", ""),
        "data:;base64," + replaced("=", "%3D"), "data:;base64," + replaced("/", "%2f"),
        "data:;base64," + replaced("/", "_"),
        "data:;base64," + base64.substr(0, 20) + "\r\n " + base64.substr(20) + "\n"}) {
    gltf.json["buffers"] = {{{"byteLength", 42}, {"uri", uri}}};
    const LoadedScene scene = SceneFolder::load("scene.gltf", gltf.json.dump());
    EXPECT_EQ(corners_of(mesh_of(scene)), kCorners) << uri;
    EXPECT_THAT(scene.warnings, IsEmpty()) << uri;
  }
}

TEST_F(GltfRepairTest, IndicesWithoutAViewAreZeros) {
  GltfBuilder gltf = triangle_gltf();
  const size_t places = gltf.add_view<uint8_t>({1, 2});
  const size_t values = gltf.add_view<uint16_t>({1, 2});
  gltf.json["accessors"][1].erase("bufferView");
  gltf.json["accessors"][1]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  LoadedScene scene = load(gltf);
  EXPECT_EQ(corners_of(mesh_of(scene)), kCorners);
  EXPECT_THAT(scene.warnings, IsEmpty());
  gltf.json["accessors"][1].erase("sparse");
  EXPECT_THAT(mesh_of(load(gltf)).triangles, ElementsAre(uvec3(0)));
}

TEST_F(GltfRepairTest, WhatNothingUsesMayBeBroken) {
  GltfBuilder gltf = triangle_gltf();
  gltf.text();
  gltf.json["accessors"].push_back({{"bufferView", 77}, {"componentType", "float"}});
  gltf.json["accessors"].push_back({{"bufferView", 2}, {"componentType", 5126}, {"count", 9}, {"type", "VEC3"}});
  gltf.json["accessors"].push_back(3);
  gltf.json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1000}});
  gltf.json["bufferViews"].push_back({{"buffer", 9}});
  gltf.json["buffers"].push_back({{"uri", 7}});
  gltf.json["buffers"].push_back(nullptr);
  const LoadedScene scene = SceneFolder::load("scene.gltf", gltf.json.dump());
  EXPECT_EQ(corners_of(mesh_of(scene)), kCorners);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(strict_refusal("strict.gltf", gltf.json.dump()), HasSubstr("accessors[2]"));
  gltf.json["buffers"].push_back({{"byteLength", 8}, {"uri", "../outside.bin"}});
  gltf.json["buffers"].push_back({{"byteLength", 8}, {"uri", "data:,broken"}});
  EXPECT_THAT(SceneFolder::load("scene.gltf", gltf.json.dump()).warnings,
              ElementsAre(HasSubstr("buffers[3] has 0 bytes"), HasSubstr("buffers[4] has 0 bytes")));
}

TEST_F(GltfRepairTest, BuffersMayLackWhatNoViewNeeds) {
  GltfBuilder gltf = triangle_gltf();
  gltf.text();
  gltf.json["buffers"][0]["byteLength"] = 100;
  LoadedScene scene = SceneFolder::load("scene.gltf", gltf.json.dump());
  EXPECT_THAT(
      scene.warnings,
      ElementsAre(
          "buffers[0]: a buffer is shorter than its byteLength (42 bytes instead of 100); the existing part is read"));
  EXPECT_EQ(corners_of(mesh_of(scene)), kCorners);
  // The view's length includes padding.
  gltf.json["bufferViews"][1]["byteLength"] = 8;
  scene = SceneFolder::load("scene.gltf", gltf.json.dump());
  EXPECT_THAT(scene.warnings, SizeIs(1));
  EXPECT_EQ(corners_of(mesh_of(scene)), kCorners);
  gltf.json["bufferViews"][1]["byteLength"] = 10;
  EXPECT_THAT(refusal("scene.gltf", gltf.json.dump()), HasProblem("gltf.buffer.short 42 100"));
}

TEST_F(GltfRepairTest, BuffersOfImagesMayBeMissing) {
  GltfBuilder gltf = triangle_gltf();
  gltf.text();
  gltf.json["buffers"].push_back({{"byteLength", 36}, {"uri", "none.bin"}});
  gltf.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 36}});
  gltf.json["images"] = {{{"bufferView", 2}, {"mimeType", "image/png"}}};
  const LoadedScene scene = SceneFolder::load("scene.gltf", gltf.json.dump());
  EXPECT_THAT(scene.warnings,
              ElementsAre("buffers[1]: a buffer of images or animations cannot be read: a referenced file does not "
                          "exist (\"none.bin\"); promin omits them"));
  EXPECT_EQ(corners_of(mesh_of(scene)), kCorners);
}

TEST_F(GltfRepairTest, EmptyAccessorsDrawNothing) {
  GltfBuilder gltf = triangle_gltf();
  const size_t none = gltf.add<float>({}, "VEC3");
  gltf.json["bufferViews"][2]["byteLength"] = 0;
  gltf.show({{"attributes", {{"POSITION", none}}}});
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(scene.warnings,
              ElementsAre(HasSubstr("bufferViews[2]: a buffer view has no bytes"),
                          HasSubstr("accessors[2].count: an accessor has no elements"),
                          HasSubstr("meshes[1].primitives[0]: a mesh primitive has too few corners for a triangle")));
  EXPECT_EQ(corners_of(mesh_of(scene)), kCorners);
}

TEST_F(GltfRepairTest, TheLastColumnOfAMatrixNeedsNoPadding) {
  GltfBuilder gltf = triangle_gltf();
  const size_t view = gltf.add_view(std::vector<uint8_t>(14, 0));
  // The buffer has two matrices of 2 x 2 bytes; their columns of 2 bytes begin 4 bytes apart.
  gltf.json["accessors"].push_back({{"bufferView", view}, {"componentType", 5121}, {"count", 2}, {"type", "MAT2"}});
  EXPECT_EQ(strict_refusal("scene.gltf", gltf.text()), "");
  gltf.json["bufferViews"][view]["byteLength"] = 13;
  EXPECT_THAT(strict_refusal("scene.gltf", gltf.text()), HasProblem("gltf.accessor.short 14 13"));
}

TEST_F(GltfRepairTest, EmptyBuffersHoldNothing) {
  GltfBuilder gltf = triangle_gltf();
  gltf.text();
  gltf.json["buffers"].push_back({{"byteLength", 0}});
  const LoadedScene scene = SceneFolder::load("scene.gltf", gltf.json.dump());
  EXPECT_THAT(scene.warnings, ElementsAre("buffers[1]: a buffer has no bytes; nothing is read from it"));
  EXPECT_NE(strict_refusal("strict.gltf", gltf.json.dump()), "");
}

TEST_F(GltfRepairTest, ColorsAreClampedAndCoordinatesReplaced) {
  GltfBuilder gltf = triangle_gltf();
  auto& attributes = primitive(gltf)["attributes"];
  attributes["COLOR_0"] = gltf.add<float>({0, -1e-8F, 2, 1.5F, kNotANumber, -1, 0, 0.5F, 1, 1, 1, 1}, "VEC4");
  attributes["TEXCOORD_0"] = gltf.add<float>({0.5F, 0.25F, INFINITY, 0.5F, 1, 2}, "VEC2");
  attributes["NORMAL"] = gltf.add<float>({0, 0, 1, kNotANumber, 0, 1, 0, 0, 1}, "VEC3");
  const LoadedScene scene = load(gltf);
  EXPECT_THAT(mesh_of(scene).colors, ElementsAre(vec4(0, 0, 2, 1), vec4(1, 0, 0, 0.5F), vec4(1)));
  EXPECT_THAT(mesh_of(scene).uvs, ElementsAre(vec4(0.5F, 0.25F, 0, 0), vec4(0), vec4(1, 2, 0, 0)));
  EXPECT_THAT(mesh_of(scene).normals, IsEmpty());
  EXPECT_THAT(scene.warnings, SizeIs(3));
}

TEST_F(GltfRepairTest, LengthsInTheHeaderOfAGlbAreRepaired) {
  const std::string good = triangle_gltf().glb();
  const auto with = [&](size_t offset, size_t value) {
    std::string bytes = good;
    return bytes.replace(offset, 4, GltfBuilder::u32(value));
  };
  const size_t json_length = static_cast<unsigned char>(good[12]) + 256 * static_cast<unsigned char>(good[13]);
  const size_t binary = 20 + json_length;
  const std::pair<std::string, const char*> kFiles[] = {
      {good.substr(0, good.size() - 2), "a GLB chunk extends beyond the end of the file (2 bytes)"},
      {with(8, 0xFFFFFFFF), "the length in the GLB header differs from the length of the chunks"},
      {with(8, 0), "the length in the GLB header differs"},
      {with(8, good.size() - 4), "the length in the GLB header differs"},
      {with(binary, 42), "a GLB chunk header is cut off"},
      {with(12 + 4, 0x4E4F534A) + GltfBuilder::u32(0) + "JSON", "bytes after the end of the GLB"},
  };
  for (const auto& [bytes, warning] : kFiles) {
    const LoadedScene scene = SceneFolder::load("a.glb", bytes);
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr(warning)));
    EXPECT_EQ(corners_of(mesh_of(scene)), kCorners) << warning;
  }
}

TEST_F(GltfRepairTest, FilesMayBeginWithAByteOrderMark) {
  EXPECT_EQ(corners_of(mesh_of(SceneFolder::load("scene.gltf", "\xEF\xBB\xBF" + triangle_gltf().text()))), kCorners);
}

TEST_F(GltfRepairTest, TheJsonOfAGlbMayBePaddedByZeros) {
  std::string bytes = triangle_gltf().glb();
  const size_t json_length = static_cast<unsigned char>(bytes[12]) + 256 * static_cast<unsigned char>(bytes[13]);
  bytes.insert(20 + json_length, std::string(4, '\0'));
  bytes.replace(12, 4, GltfBuilder::u32(json_length + 4));
  bytes.replace(8, 4, GltfBuilder::u32(bytes.size()));
  EXPECT_EQ(corners_of(mesh_of(SceneFolder::load("a.glb", bytes))), kCorners);
}

TEST_F(GltfRepairTest, VersionOneIsNamedInTextAndGlb) {
  const char* kMessage = "the file is glTF 1.0, which promin does not read";
  EXPECT_THAT(refusal("a.gltf", R"({"asset":{"version":"1.0"},"scene":"s","scenes":{"s":{"nodes":[]}}})"),
              HasSubstr(kMessage));
  EXPECT_THAT(refusal("a.gltf", R"({"asset":{"version":1.1},"scenes":[]})"), HasSubstr(kMessage));
  EXPECT_THAT(refusal("a.gltf", R"({"scene":"s","scenes":{"s":{"nodes":[]}}})"), HasSubstr(kMessage));
  std::string glb = triangle_gltf().glb();
  glb[4] = 1;
  EXPECT_THAT(refusal("a.glb", glb), HasSubstr(kMessage));
  EXPECT_THAT(refusal("a.glb", glb), HasProblem("gltf.version"));
}

TEST_F(GltfRepairTest, MeshesOfWhichNoneCanBeDrawnAreRefused) {
  GltfBuilder gltf = triangle_gltf();
  primitive(gltf)["mode"] = 1;
  EXPECT_THAT(refusal("scene.gltf", gltf.text()), HasProblem("scene.geometry.none points lines"));
  gltf.add_node({{"mesh", 0}});
  gltf.json["nodes"][0]["scale"] = {0, 0, 0};
  EXPECT_THAT(refusal("scene.gltf", gltf.text()), HasProblem("scene.geometry.none points lines"));
  gltf.json["nodes"][1]["scale"] = {0, 0, 0};
  EXPECT_THAT(load(gltf).warnings, ElementsAre(HasSubstr("nothing to draw"))) << "all is hidden";
}

}  // namespace
}  // namespace promin
