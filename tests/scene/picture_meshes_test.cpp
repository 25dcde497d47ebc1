// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scene/world_scene.h"

namespace promin {
namespace {

/// Returns a square with mirrored coordinates around 100, which must be split, shown by two objects; the second is
/// mirrored.
Scene make_scene() {
  Scene scene;
  auto image = std::make_shared<TextureImage>();
  image->size = uvec2(1);
  image->texels = {0xFFFF8080};
  image->use = ImageUse::kNormal;
  scene.images = {image};
  scene.textures = {Texture{}};
  MetallicRoughness plain;
  MetallicRoughness bumpy;
  bumpy.normal_texture.texture = 0;
  scene.materials = {{.name = "plain", .model = plain}, {.name = "bumpy", .model = bumpy}};
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(6, {0, 0, 1});
  mesh.uvs = {{101, 1, 0, 0}, {100, 1, 0, 0}, {101, 1, 0, 0}, {101, 0, 0, 0}, {100, 0, 0, 0}, {101, 0, 0, 0}};
  mesh.triangles = {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}};
  scene.add("first", mesh, 1);
  Object mirrored = scene.objects[0];
  mirrored.world_from_object = dmat4(dvec4(-1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0), dvec4(0, 0, 0, 1));
  scene.objects.push_back(mirrored);
  return scene;
}

const Mesh& mesh_of(const world::Scene& scene, size_t object) {
  return std::get<Mesh>(scene.objects.at(object).shape);
}

TEST(PictureMeshes, HaveTangentsWhereNormalsAreTextured) {
  const Scene scene = make_scene();
  const world::Scene flat = world::flatten(scene);
  for (size_t i = 0; i < 2; ++i) {
    const Mesh& mesh = mesh_of(flat, i);
    ASSERT_EQ(mesh.tangents.size(), 8U);
    EXPECT_EQ(mesh.positions.size(), 8U);
    const float side = i == 0 ? 1.0F : -1.0F;
    EXPECT_EQ(mesh.tangents[mesh.triangles[0].x], vec4(-side, 0, 0, -side));
    EXPECT_EQ(mesh.tangents[mesh.triangles[2].x], vec4(side, 0, 0, side));
    EXPECT_EQ(mesh.uvs[0], vec4(1, 1, 0, 0));
    EXPECT_EQ(mesh.uvs[1], vec4(0, 1, 0, 0));
  }
  EXPECT_EQ(std::get<Mesh>(scene.geometries[0]).positions.size(), 6U) << "the scene stays as it was";
}

TEST(PictureMeshes, GivenTangentsStay) {
  Scene scene = make_scene();
  std::get<Mesh>(scene.geometries[0]).tangents.assign(6, {0, 1, 0, 1});
  EXPECT_EQ(mesh_of(world::flatten(scene), 0).tangents, std::vector<vec4>(6, {0, 1, 0, 1}));
}

TEST(PictureMeshes, WithoutATextureStayAsTheyAre) {
  const auto expect_untouched = [](const world::Scene& scene) {
    EXPECT_TRUE(mesh_of(scene, 0).tangents.empty());
    EXPECT_EQ(mesh_of(scene, 0).uvs[0].x, 101.0F);
  };
  Scene scene = make_scene();
  for (Object& object : scene.objects) object.material = 0;
  expect_untouched(world::flatten(scene));
  // The scene has an image that could not be read.
  scene = make_scene();
  scene.images = {std::make_shared<TextureImage>()};
  expect_untouched(world::flatten(scene));
  const world::Scene hits = world::flatten(make_scene(), world::Purpose::kHits);
  expect_untouched(hits);
  EXPECT_TRUE(hits.images.empty());
}

TEST(PictureMeshes, TrianglesWithMaterialsOfTheirOwnCount) {
  Scene scene = make_scene();
  for (Object& object : scene.objects) object.material = 0;
  std::get<Mesh>(scene.geometries[0]).triangle_materials = {0, 0, 1, 0};
  EXPECT_EQ(mesh_of(world::flatten(scene), 0).tangents.size(), 8U);
}

}  // namespace
}  // namespace promin
