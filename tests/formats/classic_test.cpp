// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check which files count as written for classic light.
#include <gtest/gtest.h>

#include "support/gltf_builder.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using nlohmann::json;

class ClassicTest : public SceneFolder {
 protected:
  /// Returns whether a file with these materials is classic. It has one triangle with the first material.
  bool is_classic(const std::vector<json>& materials) const {
    GltfBuilder gltf = triangle_gltf();
    if (!materials.empty()) gltf.json["materials"] = materials;
    if (!materials.empty()) gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
    return load_scene(write("scene.gltf", gltf.text())).is_classic;
  }

  const json classic_ = {{"extensions", {{"PROMIN_materials_phong", json::object()}}}};
  const json physical_ = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}};
  const json unlit_ = {{"extensions", {{"KHR_materials_unlit", json::object()}}}};
};

TEST_F(ClassicTest, AllOfAFilesMaterialsMustBePhongs) {
  EXPECT_TRUE(is_classic({classic_}));
  EXPECT_TRUE(is_classic({classic_, classic_}));
  EXPECT_FALSE(is_classic({classic_, physical_}));
  EXPECT_FALSE(is_classic({physical_}));
  EXPECT_FALSE(is_classic({unlit_}));
  EXPECT_FALSE(is_classic({})) << "the default material is physical";
}

TEST_F(ClassicTest, APrimitiveWithoutAMaterialHasThePhysicalOne) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["materials"] = {classic_};
  EXPECT_FALSE(load_scene(write("scene.gltf", gltf.text())).is_classic);
}

TEST_F(ClassicTest, ObjFilesNeverAre) {
  write("m.mtl", "newmtl m\nKd 1 1 1\n");
  const std::string text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
  EXPECT_FALSE(load_scene(write("scene.obj", text)).is_classic);
}

}  // namespace
}  // namespace promin
