// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests load files whose coordinates lie far from the origin.

#include "formats/far_scene.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <bit>

#include "support/expect_near.h"
#include "support/ply_builder.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using test::expect_near;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// UTM coordinates, where the steps of fp32 are 0.03 and 0.5.
const dvec3 kUtm(494000.0, 5280000.0, 400.0);
/// A point on the equator, in metres from the Earth's centre.
const dvec3 kEquator(6378137.0, 0.0, 0.0);

std::string obj_at(const dvec3& place, double step) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const dvec3 v = place + step * dvec3(i % 2, i / 2, 0.25 * i);
    text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", v.x, v.y, v.z);
  }
  return text + "f 1 2 4\nf 1 4 3\n";
}

std::string stl_at(const dvec3& place) {
  return fmt::format(
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex {0:.6f} {1:.6f} {2:.6f}\nvertex {3:.6f} {1:.6f} "
      "{2:.6f}\nvertex {0:.6f} {4:.6f} {2:.6f}\nendloop\nendfacet\nendsolid\n",
      place.x, place.y, place.z, place.x + 0.125, place.y + 0.125);
}

/// Returns a triangle with vertices of this type that are 1 cm apart.
std::string ply_at(const dvec3& place, const std::string& type, double step) {
  PlyBuilder ply(std::endian::little);
  ply.header("element vertex 3\nproperty " + type + " x\nproperty " + type + " y\nproperty " + type +
             " z\nelement face 1\nproperty list uchar int vertex_indices\n");
  for (const dvec3& v : {place, place + dvec3(step, 0, 0), place + dvec3(0, step, 0)}) {
    for (int i = 0; i < 3; ++i) ply.add(type, v[i]);
  }
  ply.add("uchar", 3);
  for (int i = 0; i < 3; ++i) ply.add("int", i);
  return ply.bytes();
}

class FarSceneTest : public SceneFolder {
 protected:
  Scene load(const std::string& name, const std::string& text) const { return load_scene(write(name, text)); }
  static dvec3 corner(const Scene& scene, uint32_t index) {
    const Mesh& mesh = std::get<Mesh>(scene.geometries.at(0));
    return scene.center + dvec3(scene.objects.at(0).world_from_object * dvec4(mesh.positions.at(index), 1.0));
  }
};

TEST_F(FarSceneTest, TextIsReadInDouble) {
  const Scene obj = load("far.obj", obj_at(kUtm, 1.1));
  EXPECT_NE(obj.center, dvec3(0.0));
  expect_near(corner(obj, 1), kUtm + 1.1 * dvec3(1, 0, 0.25), 1e-6);
  EXPECT_THAT(obj.warnings, IsEmpty());
  const Scene stl = load("far.stl", stl_at(kEquator));
  expect_near(corner(stl, 1), kEquator + dvec3(0.125, 0, 0), 1e-6);
}

/// The coordinate differences of a far mesh equal those of the same mesh at the origin, bit for bit if they are exact.
TEST_F(FarSceneTest, WhatLiesFarIsAsAtTheOrigin) {
  const Scene far = load("far.obj", obj_at(kUtm, 0.25));
  const Scene near = load("near.obj", obj_at(dvec3(0.0), 0.25));
  EXPECT_EQ(near.center, dvec3(0.0));
  for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(corner(far, i) - kUtm, corner(near, i));
}

TEST_F(FarSceneTest, DoublesOfPlyKeepAMillimetre) {
  const Scene scene = load("far.ply", ply_at(kEquator, "double", 1e-3));
  expect_near(corner(scene, 0), kEquator, 1e-9);
  expect_near(corner(scene, 1), kEquator + dvec3(1e-3, 0, 0), 1e-9);
  expect_near(corner(scene, 2), kEquator + dvec3(0, 1e-3, 0), 1e-9);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

/// The loader cannot repair numbers that were rounded before they were written.
TEST_F(FarSceneTest, CoarseFloatsAreWarnedOf) {
  const Scene scene = load("far.ply", ply_at(kEquator, "float", 2.0));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("steps of 0.5 are coarse for a scene of size 2")));
  expect_near(corner(scene, 1), kEquator + dvec3(2, 0, 0), 0.0);
}

/// Returns a glTF file with the triangle, its node and the other given parts.
std::string gltf(const std::string& node, const std::string& more_nodes, const std::string& roots) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [)" + roots + R"(]}], "nodes": [)" + node +
         more_nodes + R"(], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.01}}],
    "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
      "max": [0.0078125, 0.0078125, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)" +
         "AAAAAAAAAAAAAAAAAAAAPAAAAAAAAAAAAAAAAAAAADwAAAAA\"}]}";
}

TEST_F(FarSceneTest, NodesOfGltfAreMovedInDouble) {
  const std::string child = R"({"mesh": 0, "translation": [0.015625, 0, 0]})";
  const std::string parent = R"(, {"translation": [6378137, 0, 0], "children": [0, 2, 3]})";
  const std::string camera = R"(, {"camera": 0, "translation": [0, 0, 5]})";
  const std::string light = R"(, {"translation": [0, 1.25, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}})";
  const Scene scene = load("far.gltf", gltf(child, parent + camera + light, "1"));
  EXPECT_NE(scene.center, dvec3(0.0));
  EXPECT_EQ(corner(scene, 0), kEquator + dvec3(0.015625, 0, 0));
  EXPECT_EQ(corner(scene, 1), kEquator + dvec3(0.015625 + 0.0078125, 0, 0));
  EXPECT_EQ(scene.center + dvec3(scene.cameras.at(0).eye), kEquator + dvec3(0, 0, 5));
  EXPECT_EQ(scene.center + dvec3(scene.lights.at(0).position), kEquator + dvec3(0, 1.25, 0));
  EXPECT_THAT(scene.warnings, Not(Contains(HasSubstr("coarse"))));
}

TEST_F(FarSceneTest, NffIsMovedWithItsViewAndLights) {
  const Scene scene = load("far.nff",
                           "v from 6378137 0 4 at 6378137 0 0 up 0 1 0 angle 40 hither 0 resolution 8 8\n"
                           "l 6378137.5 2 0\nf 1 1 1 1 0 0 0 0\ns 6378137.25 0 0 0.125\n");
  EXPECT_NE(scene.center, dvec3(0.0));
  EXPECT_EQ(scene.center + dvec3(std::get<Sphere>(scene.geometries.at(0)).center), kEquator + dvec3(0.25, 0, 0));
  EXPECT_EQ(scene.center + dvec3(scene.cameras.at(0).eye), kEquator + dvec3(0, 0, 4));
  EXPECT_EQ(scene.center + dvec3(scene.lights.at(0).position), kEquator + dvec3(0.5, 2, 0));
}

/// A scene near the origin needs no center. A scene that is a single point does not need one either.
TEST_F(FarSceneTest, WhatNeedsNoCenterHasNone) {
  EXPECT_EQ(load("near.obj", obj_at(dvec3(100, -50, 3), 1.1)).center, dvec3(0.0));
  const std::string mesh = obj_at(dvec3(0.1, 0, 0), 1.1);
  EXPECT_EQ(corner(load("near.obj", mesh), 0), dvec3(vec3(0.1F, 0, 0))) << "rounded once";
  EXPECT_EQ(load("point.obj", "v 0 0 0\nf 1 1 1\n").center, dvec3(0.0));
  EXPECT_EQ(load("planes.nff", "f 1 1 1 1 0 0 0 0\n").center, dvec3(0.0));
}

TEST(FarBoundsTest, StepsAreComparedWithTheSize) {
  // From 2^20 on, the steps of fp32 are 1/8.
  const vec3 far(0x1p20F, 0, 0);
  EXPECT_TRUE(is_too_coarse({far, far + 12499.0F}));
  EXPECT_FALSE(is_too_coarse({far, far + 12501.0F}));
  EXPECT_TRUE(is_too_coarse({far, far}));
  EXPECT_FALSE(is_too_coarse({vec3(0.0F), vec3(0.0F)}));
  EXPECT_FALSE(is_too_coarse({}));
  EXPECT_FALSE(is_too_coarse({vec3(-1e15F), vec3(1e15F)}));
}

TEST(FarBoundsTest, CentersHaveFewBits) {
  EXPECT_EQ(round_middle({vec3(1000, -8, 0), vec3(1010, 8, 1)}), dvec3(1004, 0, 0));
  EXPECT_EQ(round_middle({vec3(7.0F), vec3(7.0F)}), dvec3(7.0));
}

}  // namespace
}  // namespace promin
