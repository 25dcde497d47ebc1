// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "promin/validate.h"
#include "support/bad_file.h"
#include "support/ply_builder.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::string kPlace = "property float x\nproperty float y\nproperty float z\n";
const std::string kCornerList = "property list uchar int vertex_indices\n";
const std::string kSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

/// The header of a text with these elements, which are "element" lines and what follows.
std::string text_header(const std::string& elements) {
  return "ply\nformat ascii 1.0\ncomment made here\nobj_info as well\n" + elements + "end_header\n";
}

/// A square's vertices with these faces.
std::string square(const std::string& faces, int face_count) {
  return text_header("element vertex 4\n" + kPlace + "element face " + std::to_string(face_count) + "\n" +
                     kCornerList) +
         kSquare + faces;
}

class PlyTest : public SceneFolder {
 protected:
  LoadedScene load(std::string_view file) const { return SceneFolder::load("scene.ply", file); }
  std::string refusal(std::string_view file) const { return SceneFolder::refusal("scene.ply", file); }
};

TEST_F(PlyTest, TextIsRead) {
  const LoadedScene scene = load(square("3 0 1 2\n3 0 2 3\n", 2));
  EXPECT_THAT(mesh_of(scene).triangles, ElementsAre(uvec3(0, 1, 2), uvec3(0, 2, 3)));
  EXPECT_THAT(mesh_of(scene).positions, ElementsAre(vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)));
  EXPECT_THAT(mesh_of(scene).normals, IsEmpty());
  EXPECT_THAT(mesh_of(scene).colors, IsEmpty());
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.materials, SizeIs(1));
  EXPECT_EQ(scene.materials[0].phong().diffuse, vec3(0.8F));
  EXPECT_EQ(scene.materials[0].name, "default");
  EXPECT_FALSE(load_scene(folder_ / "scene.ply").is_classic);
}

TEST_F(PlyTest, LineEndsAndEmptyLinesWork) {
  EXPECT_THAT(mesh_of(load(with_carriage_returns(square("\n3 0 1 2\n\n3 +0 2 3", 2)))).triangles, SizeIs(2));
}

/// Each type of numbers holds what it can, in both orders of bytes.
TEST_F(PlyTest, BinaryFilesHoldEveryType) {
  struct Kind {
    const char* names[2];
    double lowest;
  };
  const Kind kinds[] = {{{"char", "int8"}, -128},          {{"uchar", "uint8"}, 255},
                        {{"short", "int16"}, -32768},      {{"ushort", "uint16"}, 65535},
                        {{"int", "int32"}, -2147483648.0}, {{"uint", "uint32"}, 4294967295.0},
                        {{"float", "float32"}, -0.15625},  {{"double", "float64"}, 0.1}};
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    for (const Kind& kind : kinds) {
      for (const std::string name : kind.names) {
        PlyBuilder ply(order);
        ply.header("element vertex 3\nproperty " + name + " x\nproperty " + name + " y\nproperty " + name +
                   " z\nelement face 1\nproperty list " + name + " " + name + " vertex_index\n");
        for (const double number : {kind.lowest, 1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 7.0}) ply.add(name, number);
        for (const double number : {3.0, 2.0, 0.0, 1.0}) ply.add(name, number);
        EXPECT_THAT(corners_of(mesh_of(load(ply.bytes()))),
                    ElementsAre(vec3(4, 5, 7), vec3(kind.lowest, 1.0, 0.0), vec3(1, 2, 3)))
            << name;
      }
    }
  }
}

TEST_F(PlyTest, DoublesAreRoundedToTheNearest) {
  // Just above the middle of two floats.
  const std::string file = text_header(
                               "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
                               "element face 1\n" +
                               kCornerList) +
                           "1.0000000596046450 0 0\n0 1 0\n0 0 1\n3 0 1 2\n";
  EXPECT_EQ(mesh_of(load(file)).positions[0].x, 1.0F + 0x1p-23F);
}

TEST_F(PlyTest, WhatIsUnknownIsPassedOver) {
  const std::string file = text_header(
                               "element camera 1\nproperty float view_px\nproperty list uchar float ranges\n"
                               "element face 2\nproperty uchar flags\n" +
                               kCornerList +
                               "property list int double weights\n"
                               "element nothing 1000000000000\n"
                               "element vertex 4\nproperty float quality\n" +
                               kPlace + "property list char char neighbours\n") +
                           "7 2 8 9\n"
                           "1 3 0 1 2 1 0.5\n2 3 0 2 3 0\n"
                           "9 0 0 0 0\n9 1 0 0 1 5\n9 1 1 0 2 5 6\n9 0 1 0 0\n";
  const LoadedScene scene = load(file);
  EXPECT_THAT(corners_of(mesh_of(scene)),
              ElementsAre(vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0), vec3(1, 1, 0), vec3(0, 1, 0)));
  EXPECT_THAT(scene.warnings, Contains("the element \"camera\" is ignored"));
}

TEST_F(PlyTest, PolygonsAreCutIntoTriangles) {
  const LoadedScene scene = load(square("4 0 1 2 3\n3 0 1 2\n", 2));
  EXPECT_THAT(mesh_of(scene).triangles, ElementsAre(uvec3(0, 1, 2), uvec3(0, 2, 3), uvec3(0, 1, 2)));
  // An arrow's head, whose fan around corner 0 would leave it.
  const std::string arrow = text_header("element vertex 4\n" + kPlace + "element face 1\n" + kCornerList) +
                            "1 0 0\n0 8 0\n-1 0 0\n0 10 0\n4 0 3 2 1\n";
  const LoadedScene concave = load(arrow);
  for (const uvec3& t : mesh_of(concave).triangles) EXPECT_TRUE(t.x == 1 || t.y == 1 || t.z == 1);
}

TEST_F(PlyTest, SmallFacesAreSaidAndNotDrawn) {
  const LoadedScene scene = load(square("2 0 1\n3 0 1 2\n0\n", 3));
  EXPECT_THAT(mesh_of(scene).triangles, SizeIs(1));
  EXPECT_THAT(scene.warnings, ElementsAre("faces of fewer than 3 corners are not drawn"));
}

TEST_F(PlyTest, DegenerateTrianglesKeepTheirNumber) {
  const LoadedScene scene = load(square("3 0 0 1\n3 0 1 2\n", 2));
  EXPECT_TRUE(world::is_degenerate(mesh_of(scene), 0));
  EXPECT_FALSE(world::is_degenerate(mesh_of(scene), 1));
}

TEST_F(PlyTest, StripsAreWoundOneWay) {
  const std::string file =
      text_header("element vertex 4\n" + kPlace + "element tristrips 1\nproperty list int int vertex_indices\n") +
      kSquare + "9 0 1 3 2 -1 2 3 0 1\n";
  EXPECT_THAT(corners_of(mesh_of(load(file))),
              ElementsAre(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 1, 0), vec3(1, 0, 0), vec3(1, 1, 0),
                          vec3(1, 1, 0), vec3(0, 1, 0), vec3(0), vec3(0), vec3(0, 1, 0), vec3(1, 0, 0)));
}

TEST_F(PlyTest, VerticesThatNoFaceUsesMayHoldAnything) {
  const std::string file = text_header("element vertex 4\n" + kPlace + "element face 1\n" + kCornerList) +
                           "nan inf 0\n0 0 0\n1 0 0\n0 1 0\n3 1 2 3\n";
  EXPECT_THAT(mesh_of(load(file)).positions, SizeIs(3));
}

// Normals and colours

/// A triangle with further properties; `vertices` are those of each of its three vertices.
std::string triangle(const std::string& properties, const std::vector<std::string>& vertices) {
  return text_header("element vertex 3\n" + kPlace + properties + "element face 1\n" + kCornerList) + "0 0 0 " +
         vertices.at(0) + "\n1 0 0 " + vertices.at(1) + "\n0 1 0 " + vertices.at(2) + "\n3 0 1 2\n";
}

const std::string kNormal = "property float nx\nproperty float ny\nproperty float nz\n";

TEST_F(PlyTest, NormalsAreTakenWhereAllThreeAreThere) {
  const LoadedScene scene = load(triangle(kNormal, {"0 0 2", "0 3 0", "1 0 0"}));
  EXPECT_THAT(mesh_of(scene).normals, ElementsAre(vec3(0, 0, 1), vec3(0, 1, 0), vec3(1, 0, 0)));
  EXPECT_THAT(mesh_of(load(triangle("property float nx\nproperty float ny\n", {"0 2", "3 0", "1 0"}))).normals,
              IsEmpty());
}

TEST_F(PlyTest, NormalsOfNoLengthMakeTheirFacesSharp) {
  const std::string file = text_header("element vertex 5\n" + kPlace + kNormal + "element face 2\n" + kCornerList) +
                           "0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n0 0 1 0 0 0\n1 1 1 nan 0 0\n"
                           "3 0 1 2\n4 0 3 4 1\n";
  const LoadedScene scene = load(file);
  const Mesh& mesh = mesh_of(scene);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_EQ(mesh.normals.at(mesh.triangles.at(0).x), vec3(1, 0, 0));
  for (const size_t sharp : {1, 2}) {
    const uvec3 corners = mesh.triangles.at(sharp);
    EXPECT_EQ(mesh.normals.at(corners.x), mesh.normals.at(corners.y));
    EXPECT_EQ(mesh.normals.at(corners.x), mesh.normals.at(corners.z));
    EXPECT_NE(mesh.normals.at(corners.x), vec3(1, 0, 0));
  }
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("normals of no length")));
  EXPECT_THAT(validate(load_scene(folder_ / "scene.ply")), IsEmpty());
}

TEST_F(PlyTest, ColorsAreThoseOfScreens) {
  const auto colors = [](const std::string& type) {
    return "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
  };
  // sRGB's curve: the middle code shows a fifth of the light.
  const LoadedScene bytes = load(triangle(colors("uchar"), {"0 128 255", "255 255 255", "10 10 10"}));
  EXPECT_EQ(mesh_of(bytes).colors.at(0).r, 0.0F);
  EXPECT_NEAR(mesh_of(bytes).colors.at(0).g, 0.2158605F, 1e-6F);
  EXPECT_EQ(mesh_of(bytes).colors.at(0).b, 1.0F);
  EXPECT_EQ(mesh_of(bytes).colors.at(0).a, 1.0F);
  EXPECT_NEAR(mesh_of(bytes).colors.at(2).r, 10.0F / 255.0F / 12.92F, 1e-8F);
  const LoadedScene words = load(triangle(colors("ushort"), {"0 32896 65535", "0 0 0", "0 0 0"}));
  EXPECT_EQ(mesh_of(words).colors.at(0), mesh_of(bytes).colors.at(0));
  const LoadedScene floats = load(triangle(colors("float"), {"0 0.50196078431372549 1", "0 0 0", "0 0 0"}));
  EXPECT_EQ(mesh_of(floats).colors.at(0), mesh_of(bytes).colors.at(0));
  EXPECT_THAT(floats.warnings, IsEmpty());
}

TEST_F(PlyTest, AlphaAndOtherNamesOfColors) {
  const std::string properties =
      "property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\nproperty uchar alpha\n";
  const LoadedScene scene = load(triangle(properties, {"255 0 0 51", "0 255 0 255", "0 0 255 0"}));
  EXPECT_THAT(mesh_of(scene).colors, ElementsAre(vec4(1, 0, 0, 0.2F), vec4(0, 1, 0, 1), vec4(0, 0, 1, 0)));
  EXPECT_THAT(mesh_of(load(triangle("property uchar red\nproperty uchar green\n", {"1 1", "1 1", "1 1"}))).colors,
              IsEmpty());
}

TEST_F(PlyTest, ColorsOutOfRangeAreClamped) {
  const LoadedScene scene =
      load(triangle("property float red\nproperty float green\nproperty float blue\n", {"-1 2 nan", "0 0 0", "0 0 0"}));
  EXPECT_EQ(mesh_of(scene).colors.at(0), vec4(0, 1, 0, 1));
  EXPECT_THAT(scene.warnings, ElementsAre("vertex colours below 0 or above 1 are clamped"));
}

TEST_F(PlyTest, WhatIsIgnoredIsSaid) {
  EXPECT_THAT(load(triangle("property float s\nproperty float t\n", {"0 0", "0 0", "0 0"})).warnings,
              ElementsAre("texture coordinates of PLY are ignored"));
  const std::string colored = text_header("element vertex 3\n" + kPlace + "element face 1\n" + kCornerList +
                                          "property uchar red\nproperty uchar green\nproperty uchar blue\n") +
                              "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n";
  EXPECT_THAT(load(colored).warnings, ElementsAre("colours of faces are ignored"));
  EXPECT_THAT(load(triangle("", {"4", "", ""})).warnings,
              ElementsAre("numbers beyond the properties of an element are ignored"));
}

TEST_F(PlyTest, WithoutVerticesThereIsNothingToShow) {
  const LoadedScene scene = load(text_header("element vertex 0\n" + kPlace + "element face 0\n" + kCornerList));
  EXPECT_THAT(scene.objects, IsEmpty());
  EXPECT_THAT(scene.warnings, Contains("the scene holds nothing to draw"));
}

// Refusals

class BadPlyTest : public BadFileTest {};

TEST_P(BadPlyTest, IsRefusedWithPlaceAndCure) {
  expect_refusal("bad.ply", GetParam().text);
}

const std::string kVertexElement = "element vertex 4\n" + kPlace;

/// The square's file as binary, up to its last face.
std::string cut_binary(const std::string& count_of_faces) {
  PlyBuilder ply(std::endian::little);
  ply.header(kVertexElement + "element face " + count_of_faces + "\n" + kCornerList);
  for (int i = 0; i < 12; ++i) ply.add("float", i % 5);
  ply.add("uchar", 3);
  for (const int corner : {0, 1}) ply.add("int", corner);
  return ply.bytes();
}

const BadFile kBadPly[] = {
    {"NoPly", "solid x\n", "first line is not \"ply\"", ""},
    {"NoEnd", "ply\nformat ascii 1.0\nelement vertex 3\n", "the header has no end", ": line 3"},
    {"NoFormat", "ply\nelement vertex 0\n" + kPlace + "end_header\n", "tells no format", ": line 6"},
    {"UnknownFormat", "ply\nformat binary 1.0\nend_header\n", "\"binary\" is no format", ": line 2"},
    {"UnknownType", text_header("element vertex 3\nproperty half x\n"), "\"half\" is no type", ": line 6"},
    {"UnknownListType", text_header("element face 3\nproperty list uchar long x\n"), "\"long\" is no type", ": line 6"},
    {"NegativeCount", text_header("element vertex -1\n"), "\"-1\" is no count", ": line 5"},
    {"NoCount", text_header("element vertex\n"), "\"\" is no count", ": line 5"},
    {"TwoElements", text_header("element vertex 0\nelement vertex 0\n"), "two elements \"vertex\"", ": line 6"},
    {"TwoProperties", text_header("element vertex 0\nproperty int x\nproperty float x\n"), "two properties \"x\"",
     ": line 7"},
    {"PropertyOfNothing", text_header("property int x\n"), "before any element", ": line 5"},
    {"NoVertices", text_header("element face 0\n" + kCornerList), "no element \"vertex\"", ""},
    {"NoPositions", text_header("element vertex 0\nproperty float x\n"), "no x, y and z", ""},
    {"PointCloud", text_header(kVertexElement) + kSquare, "4 vertices but no faces", ""},
    {"NoFaces", text_header(kVertexElement + "element face 0\n" + kCornerList) + kSquare, "no faces", ""},
    {"FacesWithoutCorners", text_header(kVertexElement + "element face 1\nproperty int a\n") + kSquare + "1\n",
     "no faces", ""},
    {"CountOfALie", text_header("element vertex 1000000000\n" + kPlace) + kSquare, "has room for", ""},
    {"CountOfAHugeLie", text_header("element vertex 9223372036854775807\n" + kPlace) + kSquare, "has room for", ""},
    {"CutBinaryHeader", cut_binary("1000"), "1000 rows of \"face\", the file has room for 9", ""},
    {"CutBinary", cut_binary("1"), "a count that the file has no room for", ": face 0"},
    {"CutText", square("3 0 1 2\n", 2), "ends within its rows", ""},
    {"CutRow", square("3 0 1\n3 0 1 2\n", 2), "fewer numbers", ": line 16"},
    {"NoNumber", square("3 0 1 x\n", 1), "\"x\" is no number", ": line 16"},
    {"IndexPastTheEnd", square("3 0 1 4\n", 1), "names a vertex that is not there, there are 4", ": line 16"},
    {"NegativeIndex", square("3 0 1 -1\n", 1), "names a vertex that is not there", ": line 16"},
    {"BrokenIndex", square("3 0 1 1.5\n", 1), "names a vertex that is not there", ": line 16"},
    {"CountOfNone", square("-3 0 1 2\n", 1), "a count that the file has no room for", ": line 16"},
    {"CountOfALong", square("99999999 0 1 2\n", 1), "a count that the file has no room for", ": line 16"},
    {"Nan",
     text_header("element vertex 3\n" + kPlace + "element face 1\n" + kCornerList) + "0 0 0\n0 nan 0\n1 0 0\n3 0 1 2\n",
     "not finite or beyond 1e15", ": vertex 1"},
    {"TooLarge",
     text_header("element vertex 3\n" + kPlace + "element face 1\n" + kCornerList) +
         "0 0 0\n0 1 0\n1e16 0 0\n3 0 1 2\n",
     "not finite or beyond 1e15", ": vertex 2"},
};

INSTANTIATE_TEST_SUITE_P(Table, BadPlyTest, testing::ValuesIn(kBadPly), name_of_bad_file);

TEST_F(PlyTest, TooManyCornersAreRefused) {
  std::string face = "10001";
  for (int i = 0; i < 10'001; ++i) face += i % 2 == 0 ? " 0" : " 1";
  EXPECT_THAT(refusal(square(face + "\n", 1)), HasSubstr("more than 10000 corners"));
}

}  // namespace
}  // namespace promin
