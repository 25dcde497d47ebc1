// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/turned_normals.h"

#include <gtest/gtest.h>

#include "oracle/picture.h"
#include "promin/scene.h"
#include "scene/world_scene.h"

namespace promin {
namespace {

/// Returns a square in the plane z = 0, counter-clockwise as seen from +Z, whose normals all lean by the same angle.
Mesh make_square(float normal_z) {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(4, glm::normalize(vec3(0.25F, 0.125F, normal_z)));
  mesh.uvs = {{0, 1, 0, 0}, {1, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Returns the same mesh with the other side as its front.
Mesh rewind(Mesh mesh) {
  for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
  return mesh;
}

/// Returns the oracle's colour of a mesh with a texture of normals, from one of its sides.
oracle::Vector color_from(const Mesh& mesh, float eye_z) {
  Scene scene;
  auto image = std::make_shared<TextureImage>();
  image->size = uvec2(1);
  image->texels = {0xFFC0A0B0};
  image->use = ImageUse::kNormal;
  scene.images = {image};
  scene.textures = {Texture{}};
  MetallicRoughness model;
  model.roughness = 0.5F;
  model.normal_texture.texture = 0;
  scene.materials = {{.name = "bumpy", .model = model}};
  scene.add("square", mesh);
  scene.lights.resize(1);
  scene.lights[0].position = vec3(2, 3, 4.0F * eye_z);
  View view;
  view.size = uvec2(1);
  view.camera.eye = vec3(0, 0, eye_z);
  view.camera.look = vec3(0, 0, -eye_z);
  return oracle::render(world::flatten(scene), view).at(0, 0).color;
}

TEST(TurnedNormals, CountOnlyWhatLiesAgainstTheWindingWithAllCorners) {
  EXPECT_EQ(find_turned_triangles(make_square(1)).size(), 0U);
  EXPECT_EQ(find_turned_triangles(make_square(-1)).size(), 2U);
  EXPECT_EQ(find_turned_triangles(make_square(0)).size(), 0U) << "in the plane";
  Mesh mesh = make_square(-1);
  mesh.normals[1] = vec3(0, 0, 1);
  EXPECT_EQ(find_turned_triangles(mesh).size(), 1U) << "to both sides";
  mesh.normals[0] = vec3(0.0F);
  EXPECT_EQ(find_turned_triangles(mesh).size(), 0U) << "a normal without length";
  mesh = make_square(-1);
  mesh.triangles.push_back({0, 1, 1});
  EXPECT_EQ(find_turned_triangles(mesh).size(), 2U) << "without area";
  mesh.normals.clear();
  EXPECT_EQ(find_turned_triangles(mesh).size(), 0U);
}

TEST(TurnedNormals, SplitWhatOtherTrianglesKeep) {
  Mesh mesh = make_square(-1);
  mesh.normals[1] = vec3(0, 0, 1);
  const Mesh before = mesh;
  turn_normals(mesh, find_turned_triangles(mesh), true);
  ASSERT_EQ(mesh.positions.size(), 6U) << "corners 0 and 2 of both triangles";
  EXPECT_EQ(mesh.uvs.size(), 6U);
  EXPECT_EQ(mesh.triangles[0], before.triangles[0]);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.positions[mesh.triangles[1][i]], before.positions[before.triangles[1][i]]);
    EXPECT_EQ(mesh.normals[mesh.triangles[1][i]], -before.normals[before.triangles[1][i]]);
    EXPECT_EQ(mesh.normals[mesh.triangles[0][i]], before.normals[before.triangles[0][i]]);
  }
}

TEST(TurnedNormals, ShadeAsIfTheyWereWoundLikeTheirNormals) {
  for (const float eye_z : {4.0F, -4.0F}) {
    const oracle::Vector right = color_from(rewind(make_square(-1)), eye_z);
    EXPECT_GT(right.x, 0.001L) << "lit";
    EXPECT_LE(glm::distance(color_from(make_square(-1), eye_z), right), 1e-6L) << eye_z;
    Mesh with_tangents = make_square(-1);
    with_tangents.tangents.assign(4, vec4(1, 0, 0, -1));
    EXPECT_LE(glm::distance(color_from(with_tangents, eye_z), color_from(rewind(with_tangents), eye_z)), 1e-6L)
        << eye_z;
  }
}

TEST(TurnedNormals, StayAsTheyAreForHits) {
  Scene scene;
  scene.materials.resize(1);
  scene.add("square", make_square(-1));
  const auto normals_of = [&](world::Purpose purpose) {
    return std::get<Mesh>(world::flatten(scene, purpose).objects[0].shape).normals;
  };
  EXPECT_LT(normals_of(world::Purpose::kHits)[0].z, 0.0F);
  EXPECT_GT(normals_of(world::Purpose::kPictures)[0].z, 0.0F);
  scene.objects[0].world_from_object[0][0] = -1.0;
  EXPECT_GT(normals_of(world::Purpose::kPictures)[0].z, 0.0F) << "mirrored";
}

}  // namespace
}  // namespace promin
