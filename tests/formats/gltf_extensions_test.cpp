// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Extensions of glTF that are not known, or change how the rest of the file is read.
#include <gmock/gmock.h>

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

/// The triangle, in a file that cannot be shown without KHR_materials_foo, which three materials have.
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
  EXPECT_EQ(scene.extensions[0].use, ExtensionUse::kIgnored);
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
  EXPECT_THAT(message, HasSubstr("the required extension KHR_materials_foo is not implemented"));
  EXPECT_THAT(message, HasSubstr("extensionsRequired[0]"));
  gltf.json.erase("extensionsRequired");
  EXPECT_EQ(refusal_of(gltf, {.is_strict = true}), "") << "it is not required";
}

TEST_F(GltfExtensionsTest, UnknownOnesOfTheFileAreAWarning) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["extensionsRequired"] = {"EXT_fog"};
  gltf.json["scenes"] = {{{"nodes", {0}}, {"extensions", {{"EXT_fog", json::object()}}}}};
  EXPECT_THAT(load(gltf).warnings,
              ElementsAre("the file requires EXT_fog, which is not known; it is shown without it"));
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
    EXPECT_THAT(message, HasSubstr("the required extension EXT_packed is not implemented"));
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
  EXPECT_EQ(scene.extensions[0].use, ExtensionUse::kUsed);
}

/// A PNG of one pixel: 80 hexadecimal of red, 40 of green, 20 of blue.
const std::string kPixel =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNocFAAAAIkAOGVpLGLAAAAAElFTkSuQmCC";

/// The triangle in a material whose base colour is a texture.
GltfBuilder textured_gltf(const json& texture) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
  gltf.json["textures"] = {texture};
  gltf.json["images"] = {{{"uri", "missing.png"}}, {{"uri", kPixel}}};
  return gltf;
}

TEST_F(GltfExtensionsTest, TexturesFallBackOnTheImageOfCoreGltf) {
  GltfBuilder gltf = textured_gltf({{"source", 1}, {"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
  gltf.json["extensionsUsed"] = {"KHR_texture_basisu"};
  const Scene scene = load(gltf);
  EXPECT_THAT(scene.warnings,
              ElementsAre("1 texture uses KHR_texture_basisu, which is not known; an image that is named "
                          "beside it is taken, or none"));
  ASSERT_EQ(scene.images.size(), 1U);
  EXPECT_EQ(scene.images[0]->texels, std::vector<uint32_t>{0xFF204080});
}

TEST_F(GltfExtensionsTest, TexturesWithoutAKnownImageAreAbsent) {
  GltfBuilder gltf = textured_gltf({{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
  gltf.json["extensionsRequired"] = {"KHR_texture_basisu"};
  const Scene scene = load(gltf);
  EXPECT_THAT(scene.warnings,
              ElementsAre("1 texture uses KHR_texture_basisu, which is required but not known; an image that is named "
                          "beside it is taken, or none",
                          "1 texture has no image that is known; materials are drawn without"));
  EXPECT_FALSE(std::get<MetallicRoughness>(scene.materials[0].model).base_color_texture.exists());
}

TEST_F(GltfExtensionsTest, TexturesOfWebpNameTheirImage) {
  GltfBuilder gltf = textured_gltf({{"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}});
  EXPECT_EQ(load(gltf).images.at(0)->texels, std::vector<uint32_t>{0xFF204080}) << "its bytes tell what it is";
  gltf.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 2;
  EXPECT_THAT(refusal_of(gltf), HasSubstr("textures[0].extensions.EXT_texture_webp.source"));
}

TEST_F(GltfExtensionsTest, TexturesOfSpecularAreSaidToBeIgnored) {
  GltfBuilder gltf = textured_gltf({{"source", 1}});
  gltf.json["materials"][0]["extensions"]["KHR_materials_specular"]["specularTexture"]["index"] = 0;
  const Scene scene = load(gltf);
  EXPECT_THAT(scene.warnings,
              ElementsAre("1 material has textures of KHR_materials_specular, which are ignored; the factors hold"));
  EXPECT_EQ(scene.extensions.at(0).use, ExtensionUse::kApproximated);
}

}  // namespace
}  // namespace promin
