// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests load glTF files with extensions that promin does not know, or that change how the rest of the file is
// read.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "promin/error.h"
#include "support/gltf_builder.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class GltfExtensionsTest : public SceneFolder {
 protected:
  Scene load(GltfBuilder& gltf, const LoadOptions& options = {}) const {
    return load_scene(write("scene.gltf", gltf.text()), options);
  }
  std::string refusal_of(GltfBuilder& gltf, const LoadOptions& options = {}) const {
    return message_of([&] { load(gltf, options); });
  }
};

const json kFoo = {{"KHR_materials_foo", json::object()}};

/// Returns the triangle in a file that requires KHR_materials_foo, which three materials have.
GltfBuilder gltf_with_foo() {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["extensionsUsed"] = {"KHR_materials_foo"};
  gltf.json["extensionsRequired"] = {"KHR_materials_foo"};
  gltf.json["materials"] = {{{"extensions", kFoo}}, json::object(), {{"extensions", kFoo}}, {{"extensions", kFoo}}};
  gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
  return gltf;
}

TEST_F(GltfExtensionsTest, UnknownOnesOfMaterialsAreOneWarning) {
  GltfBuilder gltf = gltf_with_foo();
  const Scene scene = load(gltf);
  EXPECT_THAT(scene.warnings,
              ElementsAre("3 materials use KHR_materials_foo, which is required but not known; they are "
                          "drawn without it"));
  ASSERT_EQ(scene.extensions.size(), 1U);
  EXPECT_EQ(scene.extensions[0].name, "KHR_materials_foo");
  EXPECT_FALSE(scene.extensions[0].is_used);
  EXPECT_TRUE(scene.extensions[0].is_required);
  EXPECT_EQ(scene.objects.size(), 1U);
}

TEST_F(GltfExtensionsTest, UnknownOnesThatAreNotListedAreSaidToo) {
  GltfBuilder gltf = gltf_with_foo();
  gltf.json.erase("extensionsUsed");
  gltf.json.erase("extensionsRequired");
  EXPECT_THAT(load(gltf).warnings,
              ElementsAre("3 materials use KHR_materials_foo, which is not known; they are drawn without it"));
}

TEST_F(GltfExtensionsTest, ExtrasAreNoExtensions) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["materials"] = {{{"extras", {{"extensions", kFoo}}}}};
  EXPECT_THAT(load(gltf).warnings, IsEmpty());
}

TEST_F(GltfExtensionsTest, StrictlyAnyUnknownOneIsRefused) {
  GltfBuilder gltf = gltf_with_foo();
  const std::string message = refusal_of(gltf, {.is_strict = true});
  EXPECT_THAT(message, HasProblem("gltf.extension.required KHR_materials_foo"));
  EXPECT_THAT(message, HasSubstr("extensionsRequired[0]"));
  gltf.json.erase("extensionsRequired");
  EXPECT_EQ(refusal_of(gltf, {.is_strict = true}), "") << "it is not required";
}

TEST_F(GltfExtensionsTest, UnknownOnesOfTheFileAreAWarning) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["extensionsRequired"] = {"EXT_fog"};
  gltf.json["scenes"] = {{{"nodes", {0}}, {"extensions", {{"EXT_fog", json::object()}}}}};
  EXPECT_THAT(load(gltf).warnings,
              ElementsAre("the file requires EXT_fog, which is unknown; promin shows the scene without it"));
}

TEST_F(GltfExtensionsTest, UnknownOnesOfGeometryAreRefused) {
  const std::pair<const char*, const char*> places[] = {{"/buffers/0", "buffers[0]"},
                                                        {"/bufferViews/1", "bufferViews[1]"},
                                                        {"/accessors/0", "accessors[0]"},
                                                        {"/nodes/0", "nodes[0]"},
                                                        {"/meshes/0/primitives/0", "meshes[0].primitives[0]"}};
  for (const auto& [pointer, place] : places) {
    GltfBuilder gltf = triangle_gltf();
    gltf.text();
    gltf.json["extensionsRequired"] = {"EXT_packed"};
    gltf.json[json::json_pointer(pointer)]["extensions"] = {{"EXT_packed", json::object()}};
    const std::string message = message_of([&] { load_scene(write("scene.gltf", gltf.json.dump())); });
    EXPECT_THAT(message, HasProblem("gltf.extension.required EXT_packed"));
    EXPECT_THAT(message, HasSubstr("scene.gltf: " + std::string(place)));
    gltf.json.erase("extensionsRequired");
    EXPECT_NO_THROW(load_scene(write("scene.gltf", gltf.json.dump()))) << place;
  }
}

TEST_F(GltfExtensionsTest, KnownOnesOfNodesAreNotRefused) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["extensionsUsed"] = {"KHR_node_visibility", "KHR_mesh_quantization"};
  gltf.json["extensionsRequired"] = {"KHR_node_visibility", "KHR_mesh_quantization"};
  gltf.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = true;
  const Scene scene = load(gltf, {.is_strict = true});
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_EQ(scene.extensions.size(), 2U);
  EXPECT_TRUE(scene.extensions[0].is_used);
}

/// A PNG of one pixel with the codes 80 (red), 40 (green) and 20 (blue), all hexadecimal.
const std::string kPngPixel =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNocFAAAAIkAOGVpLGLAAAAAElFTkSuQmCC";

/// Returns the triangle with a material whose base colour is a texture.
GltfBuilder textured_gltf(const json& texture) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
  gltf.json["textures"] = {texture};
  gltf.json["images"] = {{{"uri", "missing.png"}}, {{"uri", kPngPixel}}};
  return gltf;
}

TEST_F(GltfExtensionsTest, TexturesFallBackOnTheImageOfCoreGltf) {
  GltfBuilder gltf = textured_gltf({{"source", 1}, {"extensions", {{"MSFT_texture_dds", {{"source", 0}}}}}});
  gltf.json["extensionsUsed"] = {"MSFT_texture_dds"};
  const Scene scene = load(gltf);
  EXPECT_THAT(
      scene.warnings,
      ElementsAre("1 texture uses MSFT_texture_dds, which is not known; an alternative image is used, or none"));
  ASSERT_EQ(scene.images.size(), 1U);
  EXPECT_EQ(scene.images[0]->texels, std::vector<uint32_t>{0xFF204080});
}

TEST_F(GltfExtensionsTest, TexturesWithoutAKnownImageAreAbsent) {
  GltfBuilder gltf = textured_gltf({{"extensions", {{"MSFT_texture_dds", {{"source", 0}}}}}});
  gltf.json["extensionsRequired"] = {"MSFT_texture_dds"};
  const Scene scene = load(gltf);
  EXPECT_THAT(
      scene.warnings,
      ElementsAre(
          "1 texture uses MSFT_texture_dds, which is required but not known; an alternative image is used, or none",
          "1 texture has no image of a known format; promin draws materials without these textures"));
  EXPECT_FALSE(std::get<MetallicRoughness>(scene.materials[0].model).base_color_texture.exists());
}

TEST_F(GltfExtensionsTest, TexturesOfOtherFormatsNameTheirImage) {
  for (const std::string name : {"EXT_texture_avif", "EXT_texture_webp", "KHR_texture_basisu"}) {
    GltfBuilder gltf = textured_gltf({{"extensions", {{name, {{"source", 1}}}}}});
    gltf.json["extensionsRequired"] = {name};
    const Scene scene = load(gltf, {.is_strict = true});
    EXPECT_THAT(scene.warnings, IsEmpty()) << name;
    EXPECT_EQ(scene.images.at(0)->texels, std::vector<uint32_t>{0xFF204080}) << "its bytes say what it is";
    gltf.json["textures"][0]["extensions"][name]["source"] = 2;
    EXPECT_THAT(load(gltf).warnings, Contains(HasSubstr("textures[0].extensions." + name + ".source")));
  }
}

const MetallicRoughness& metal_of(const Scene& scene) {
  return std::get<MetallicRoughness>(scene.materials.at(0).model);
}

TEST_F(GltfExtensionsTest, TexturesOfLayersAreRead) {
  GltfBuilder gltf = textured_gltf({{"source", 1}});
  json& extensions = gltf.json["materials"][0]["extensions"];
  extensions["KHR_materials_specular"]["specularTexture"]["index"] = 0;
  extensions["KHR_materials_specular"]["specularColorTexture"]["index"] = 0;
  extensions["KHR_materials_sheen"]["sheenColorTexture"]["index"] = 0;
  extensions["KHR_materials_sheen"]["sheenRoughnessTexture"]["index"] = 0;
  extensions["KHR_materials_diffuse_transmission"]["diffuseTransmissionTexture"]["index"] = 0;
  extensions["KHR_materials_diffuse_transmission"]["diffuseTransmissionColorTexture"]["index"] = 0;
  extensions["KHR_materials_iridescence"]["iridescenceTexture"]["index"] = 0;
  extensions["KHR_materials_iridescence"]["iridescenceThicknessTexture"]["index"] = 0;
  extensions["KHR_materials_anisotropy"]["anisotropyTexture"]["index"] = 0;
  const Scene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  const MetallicRoughness& model = metal_of(scene);
  const auto use_of = [&](const TextureSlot& slot) {
    return scene.images.at(scene.textures.at(slot.texture).image)->use;
  };
  EXPECT_EQ(use_of(model.specular_texture), ImageUse::kData);
  EXPECT_EQ(use_of(model.specular_color_texture), ImageUse::kColor);
  EXPECT_EQ(use_of(model.sheen_color_texture), ImageUse::kColor);
  EXPECT_EQ(use_of(model.sheen_roughness_texture), ImageUse::kData);
  EXPECT_EQ(use_of(model.diffuse_transmission_texture), ImageUse::kData);
  EXPECT_EQ(use_of(model.diffuse_transmission_color_texture), ImageUse::kColor);
  EXPECT_EQ(use_of(model.iridescence_texture), ImageUse::kData);
  EXPECT_EQ(use_of(model.iridescence_thickness_texture), ImageUse::kData);
  EXPECT_EQ(use_of(model.anisotropy_texture), ImageUse::kData);
}

// The next tests check the specular-glossiness model.

/// Two pixels: red and blue are 80 hexadecimal with a glossiness of 1; blue is 80 with a glossiness of 1/5.
const std::string kGlossyPixels =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR42mP4z9Dwn4GhwRgAES8DMu8hmVcAAAAASUVORK5CYII=";

/// Returns the triangle with a material of KHR_materials_pbrSpecularGlossiness.
GltfBuilder glossy_gltf(const json& extension) {
  GltfBuilder gltf = textured_gltf({{"source", 0}});
  gltf.json["images"] = {{{"uri", kGlossyPixels}}};
  gltf.json["materials"] = {{{"extensions", {{"KHR_materials_pbrSpecularGlossiness", extension}}}}};
  return gltf;
}

TEST_F(GltfExtensionsTest, SpecularGlossinessIsADielectricThatReflectsItsSpecularColor) {
  GltfBuilder gltf = glossy_gltf(
      {{"diffuseFactor", {0.5, 0.25, 0, 1}}, {"specularFactor", {0.25, 0.5, 1}}, {"glossinessFactor", 0.75}});
  const Scene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(metal_of(scene).base_color, vec3(0.5F, 0.25F, 0));
  EXPECT_EQ(metal_of(scene).specular_color, vec3(0.25F, 0.5F, 1));
  EXPECT_EQ(metal_of(scene).specular, 1.0F);
  EXPECT_EQ(metal_of(scene).metallic, 0.0F);
  EXPECT_EQ(metal_of(scene).ior, 0.0F) << "so that the specular colour is the reflectance";
  EXPECT_EQ(metal_of(scene).roughness, 0.25F);
  EXPECT_TRUE(scene.extensions.at(0).is_used);
}

TEST_F(GltfExtensionsTest, SpecularGlossinessHasTheExtensionsDefaults) {
  GltfBuilder gltf = glossy_gltf(json::object());
  const Scene scene = load(gltf);
  EXPECT_EQ(metal_of(scene).base_color, vec3(1));
  EXPECT_EQ(metal_of(scene).specular_color, vec3(1));
  EXPECT_EQ(metal_of(scene).roughness, 0.0F);
}

TEST_F(GltfExtensionsTest, TexturesOfGlossinessBecomeSuchOfRoughness) {
  for (const double factor : {1.0, 0.5}) {
    GltfBuilder gltf = glossy_gltf({{"diffuseTexture", {{"index", 0}}},
                                    {"specularFactor", {1, 1, 0.5}},
                                    {"glossinessFactor", factor},
                                    {"specularGlossinessTexture", {{"index", 0}}}});
    const Scene scene = load(gltf);
    const MetallicRoughness& model = metal_of(scene);
    const Texture& texture = scene.textures.at(model.metallic_roughness_texture.texture);
    const TextureImage& image = *scene.images.at(texture.image);
    EXPECT_EQ(image.use, ImageUse::kData);
    // The roughness codes are 255 - 255 and 255 - 51. With half of the effect, half is subtracted, rounded up.
    const std::vector<uint32_t> expected =
        factor == 1.0 ? std::vector<uint32_t>{0xFF000000, 0xFF00CC00} : std::vector<uint32_t>{0xFF008000, 0xFF00E600};
    EXPECT_EQ(image.texels, expected);
    EXPECT_EQ(model.roughness, 1.0F) << "the texture has the factor in it";
    EXPECT_EQ(model.specular_color, vec3(1, 1, 0.5F));
    EXPECT_EQ(model.specular_color_texture.texture, model.base_color_texture.texture);
    EXPECT_EQ(scene.images.size(), 2U) << "the diffuse texture and that of specular colours keep their texels";
    EXPECT_EQ(scene.images.at(scene.textures.at(model.base_color_texture.texture).image)->texels,
              (std::vector<uint32_t>{0xFF8000FF, 0x33800000}));
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_TRUE(scene.extensions.at(0).is_used);
  }
}

TEST_F(GltfExtensionsTest, GlossinessHoldsWhereItsTextureIsMissing) {
  GltfBuilder gltf = glossy_gltf({{"glossinessFactor", 0.75}, {"specularGlossinessTexture", {{"index", 0}}}});
  gltf.json["images"] = {{{"uri", "missing.png"}}};
  const Scene scene = load(gltf);
  EXPECT_EQ(metal_of(scene).roughness, 0.25F);
  EXPECT_EQ(metal_of(scene).specular_color, vec3(1));
}

// The next tests check variants.

/// Returns the triangle with material 0; the variant "dawn" has material 1 and "night" has 2.
GltfBuilder varied_gltf() {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["materials"] = {json::object(), json::object(), json::object()};
  gltf.json["extensions"]["KHR_materials_variants"]["variants"] = {
      {{"name", "noon"}}, {{"name", "dawn"}}, {{"name", "night"}}};
  json& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 2}, {"variants", {2}}},
                                                                   {{"material", 1}, {"variants", {1}}}};
  return gltf;
}

TEST_F(GltfExtensionsTest, VariantsChooseMaterials) {
  GltfBuilder gltf = varied_gltf();
  const Scene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(scene.variants, ElementsAre("noon", "dawn", "night"));
  EXPECT_EQ(scene.objects.at(0).material, 0U);
  EXPECT_EQ(load(gltf, {.material_variant = "dawn"}).objects.at(0).material, 1U);
  EXPECT_EQ(load(gltf, {.material_variant = "night"}).objects.at(0).material, 2U);
  EXPECT_EQ(load(gltf, {.material_variant = "noon"}).objects.at(0).material, 0U) << "it says nothing of the primitive";
}

TEST_F(GltfExtensionsTest, UnknownVariantsNameTheKnownOnes) {
  GltfBuilder gltf = varied_gltf();
  try {
    load(gltf, {.material_variant = "dusk"});
    FAIL() << "it loads";
  } catch (const UsageError& error) {
    EXPECT_THAT(list_problems(error), HasProblem("scene.variant.unknown \"dusk\" \"noon\" \"dawn\" \"night\""));
  }
  GltfBuilder plain = triangle_gltf();
  EXPECT_THROW(load(plain, {.material_variant = "dusk"}), UsageError);
}

TEST_F(GltfExtensionsTest, OtherFormatsHaveNoVariants) {
  const struct {
    std::string ending;
    std::string text;
  } kFiles[] = {{".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
                {".ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
                {".stl",
                 "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                 "endfacet\nendsolid a\n"}};
  for (const auto& [ending, text] : kFiles) {
    const std::filesystem::path file = write("a" + ending, text);
    EXPECT_EQ(load_scene(file).objects.size(), 1U) << ending;
    EXPECT_THAT([&] { load_scene(file, {.material_variant = "dusk"}); }, FailsWith("scene.variant.unknown " + ending));
  }
}

TEST_F(GltfExtensionsTest, MappingsToVariantsThatAreNotThereAreIgnored) {
  GltfBuilder gltf = varied_gltf();
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"][1]["variants"] = {3};
  EXPECT_THAT(load(gltf).warnings, ElementsAre(HasSubstr("an index is out of range (index 3)")));
}

// The next tests check instances.

/// Returns the triangle, shown by a node at (1, 0, 0).
GltfBuilder instanced_gltf(const json& attributes) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["nodes"][0]["translation"] = {1, 0, 0};
  gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
  return gltf;
}

json& instances_of(GltfBuilder& gltf) {
  return gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
}

TEST_F(GltfExtensionsTest, InstancesAreCopiesInTheirPlaces) {
  GltfBuilder gltf = instanced_gltf(json::object());
  const auto half = static_cast<float>(std::sqrt(0.5));
  instances_of(gltf)["TRANSLATION"] = gltf.add<float>({0, 0, 0, 0, 5, 0}, "VEC3");
  instances_of(gltf)["ROTATION"] = gltf.add<float>({0, 0, 0, 1, 0, 0, half, half}, "VEC4");
  instances_of(gltf)["SCALE"] = gltf.add<float>({1, 1, 1, 2, 1, 1}, "VEC3");
  instances_of(gltf)["_ID"] = gltf.add<float>({7, 8}, "SCALAR");
  const Scene scene = load(gltf);
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.geometries.size(), 1U) << "copies share their geometry";
  EXPECT_EQ(scene.objects[1].geometry, 0U);
  EXPECT_EQ(dvec3(scene.objects[0].world_from_object * dvec4(1, 0, 0, 1)), dvec3(2, 0, 0));
  // The corner is scaled to (2, 0, 0), rotated to (0, 2, 0), moved by (0, 5, 0), and then moved by the node.
  const dvec3 corner(scene.objects[1].world_from_object * dvec4(1, 0, 0, 1));
  EXPECT_LT(glm::distance(corner, dvec3(1, 7, 0)), 1e-6);
}

TEST_F(GltfExtensionsTest, RotationsOfInstancesMayBeNormalizedIntegers) {
  GltfBuilder gltf = instanced_gltf(json::object());
  instances_of(gltf)["ROTATION"] = gltf.add<int16_t>({0, 0, 32767, 0}, "VEC4", true);
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_LT(glm::distance(dvec3(scene.objects[0].world_from_object * dvec4(1, 0, 0, 1)), dvec3(0, 0, 0)), 1e-6);
}

TEST_F(GltfExtensionsTest, BadInstancesAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refusal_with = [&](const char* name, const std::vector<float>& numbers, const std::string& type) {
    GltfBuilder gltf = instanced_gltf(json::object());
    instances_of(gltf)[name] = gltf.add<float>(numbers, type);
    return refusal_of(gltf);
  };
  EXPECT_EQ(refusal_with("ROTATION", {0, 0, 0, 0}, "VEC4"), "") << "that is a warning";
  EXPECT_THAT(refusal_with("TRANSLATION", {0, 0, 0, 0, nan, 0}, "VEC3"), HasSubstr("TRANSLATION, element 1"));
  EXPECT_THAT(refusal_with("SCALE", {1, 1}, "VEC2"), HasProblem("gltf.accessor.format"));
  EXPECT_THAT(refusal_with("SCALE", {1e30F, 1, 1}, "VEC3"), HasProblem("gltf.position.far"));

  GltfBuilder uneven = instanced_gltf(json::object());
  instances_of(uneven)["SCALE"] = uneven.add<float>({1, 1, 1}, "VEC3");
  instances_of(uneven)["TRANSLATION"] = uneven.add<float>({1, 1, 1, 2, 2, 2}, "VEC3");
  EXPECT_THAT(refusal_of(uneven), HasProblem("gltf.accessor.count"));

  GltfBuilder empty = instanced_gltf(json::object());
  empty.json["accessors"].push_back({{"componentType", 5126}, {"count", 16000000}, {"type", "VEC3"}});
  instances_of(empty)["SCALE"] = empty.json["accessors"].size() - 1;
  EXPECT_THAT(refusal_of(empty), HasProblem("gltf.instances.missing"));
}

TEST_F(GltfExtensionsTest, TooManyInstancesAreRefusedBeforeTheyAreTaken) {
  GltfBuilder gltf = instanced_gltf(json::object());
  // The file has 2^12 instances of a mesh with 2^12 + 1 primitives, but a scene has at most 2^24 objects.
  json& primitives = gltf.json["meshes"][0]["primitives"];
  primitives = std::vector<json>((1 << 12) + 1, primitives[0]);
  instances_of(gltf)["SCALE"] = gltf.add(std::vector<float>(3 << 12, 1.0F), "VEC3");
  EXPECT_THAT(refusal_of(gltf), HasProblem("scene.size.limit 0 4096 4097"));
}

}  // namespace
}  // namespace promin
