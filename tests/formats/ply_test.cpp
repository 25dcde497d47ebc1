// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "promin/validate.h"
#include "support/bad_file.h"
#include "support/make_png.h"
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
const std::string kSquareRows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

/// Returns the header of a text file with these elements, which are "element" lines and their properties.
std::string text_header(const std::string& elements) {
  return "ply\nformat ascii 1.0\ncomment made here\nobj_info as well\n" + elements + "end_header\n";
}

/// Returns a square's vertices with these faces.
std::string square(const std::string& faces, int face_count) {
  return text_header("element vertex 4\n" + kPlace + "element face " + std::to_string(face_count) + "\n" +
                     kCornerList) +
         kSquareRows + faces;
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

TEST_F(PlyTest, LinesMayEndInCarriageReturnsAlone) {
  std::string text = square("3 0 1 2\n3 0 2 3\n", 2);
  std::ranges::replace(text, '\n', '\r');
  EXPECT_THAT(mesh_of(load(text)).triangles, ElementsAre(uvec3(0, 1, 2), uvec3(0, 2, 3)));
}

/// Returns a triangle whose first byte of numbers looks like the end of a line; `end` is the line end of the header.
std::string tricky_binary(const std::string& end) {
  PlyBuilder ply(std::endian::little);
  ply.header("element face 1\nproperty uchar flags\n" + kCornerList + "element vertex 3\n" + kPlace);
  std::string header;
  for (const char c : ply.bytes()) header += c == '\n' ? end : std::string(1, c);
  PlyBuilder rows(std::endian::little);
  for (const double number : {10.0, 3.0}) rows.add("uchar", number);
  for (const double number : {0.0, 1.0, 2.0}) rows.add("int", number);
  for (const double number : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0}) rows.add("float", number);
  return header + rows.bytes();
}

TEST_F(PlyTest, ABinaryBodyBeginsBehindTheEndOfALineAsTheFirstLineHasIt) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const LoadedScene scene = load(tricky_binary(end));
    EXPECT_THAT(corners_of(mesh_of(scene)), ElementsAre(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0))) << end.size();
    EXPECT_THAT(scene.warnings, IsEmpty());
  }
}

TEST_F(PlyTest, ZeroBytesBehindATextAreCutOff) {
  EXPECT_THAT(mesh_of(load(square("3 0 1 2", 1) + std::string(5, '\0'))).triangles, SizeIs(1));
}

/// Each type of numbers can hold its whole range, in both byte orders.
TEST_F(PlyTest, BinaryFilesHoldEveryType) {
  struct NumberKind {
    const char* names[2];
    double lowest;
  };
  const NumberKind kinds[] = {{{"char", "int8"}, -128},          {{"uchar", "uint8"}, 255},
                              {{"short", "int16"}, -32768},      {{"ushort", "uint16"}, 65535},
                              {{"int", "int32"}, -2147483648.0}, {{"uint", "uint32"}, 4294967295.0},
                              {{"float", "float32"}, -0.15625},  {{"double", "float64"}, 0.1}};
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    for (const NumberKind& kind : kinds) {
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
  // The number lies just above the middle of two floats.
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
  // The polygon is an arrow's head; a fan around corner 0 would leave it.
  const std::string arrow = text_header("element vertex 4\n" + kPlace + "element face 1\n" + kCornerList) +
                            "1 0 0\n0 8 0\n-1 0 0\n0 10 0\n4 0 3 2 1\n";
  const LoadedScene concave = load(arrow);
  for (const uvec3& t : mesh_of(concave).triangles) EXPECT_TRUE(t.x == 1 || t.y == 1 || t.z == 1);
}

TEST_F(PlyTest, SmallFacesAreSaidAndNotDrawn) {
  const LoadedScene scene = load(square("2 0 1\n3 0 1 2\n0\n", 3));
  EXPECT_THAT(mesh_of(scene).triangles, SizeIs(1));
  EXPECT_THAT(scene.warnings,
              ElementsAre("line 16: a face has fewer than 3 corners, and 1 more; promin omits the face"));
}

TEST_F(PlyTest, DegenerateTrianglesKeepTheirNumber) {
  const LoadedScene scene = load(square("3 0 0 1\n3 0 1 2\n", 2));
  EXPECT_TRUE(world::is_degenerate(mesh_of(scene), 0));
  EXPECT_FALSE(world::is_degenerate(mesh_of(scene), 1));
}

TEST_F(PlyTest, StripsAreWoundOneWay) {
  const std::string file =
      text_header("element vertex 4\n" + kPlace + "element tristrips 1\nproperty list int int vertex_indices\n") +
      kSquareRows + "9 0 1 3 2 -1 2 3 0 1\n";
  EXPECT_THAT(corners_of(mesh_of(load(file))),
              ElementsAre(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 1, 0), vec3(1, 0, 0), vec3(1, 1, 0),
                          vec3(1, 1, 0), vec3(0, 1, 0), vec3(0), vec3(0), vec3(0, 1, 0), vec3(1, 0, 0)));
}

TEST_F(PlyTest, VerticesThatNoFaceUsesMayHoldAnything) {
  const std::string file = text_header("element vertex 4\n" + kPlace + "element face 1\n" + kCornerList) +
                           "nan inf 0\n0 0 0\n1 0 0\n0 1 0\n3 1 2 3\n";
  EXPECT_THAT(mesh_of(load(file)).positions, SizeIs(3));
}

TEST_F(PlyTest, FacesWithoutAPlaceAreLeftOut) {
  const std::string file = text_header("element vertex 5\n" + kPlace + "element face 4\n" + kCornerList) + kSquareRows +
                           "1.#QNAN 0 0\n3 0 1 4\n3 0 1 2\n4 0 1 2 4\n3 0 2 3\n";
  const LoadedScene scene = load(file);
  EXPECT_THAT(mesh_of(scene).triangles, ElementsAre(uvec3(0, 1, 2), uvec3(0, 2, 3)));
  EXPECT_THAT(mesh_of(scene).positions, SizeIs(4));
  EXPECT_THAT(scene.warnings, ElementsAre("vertex 4: a face has a vertex coordinate that is not a number up to 1e15, "
                                          "and 1 more; promin omits the face"));
  EXPECT_THROW(load_scene(folder_ / "scene.ply", {.is_strict = true}), InputError);
}

TEST_F(PlyTest, NumbersBeyondDoubleAreThoseOfTheirSide) {
  const std::string file = text_header("element vertex 3\n" + kPlace + "element face 1\n" + kCornerList);
  EXPECT_EQ(mesh_of(load(file + "1e-999 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")).positions[0], vec3(0.0F));
  EXPECT_THAT(refusal(file + "1e999 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), HasProblem("scene.geometry.none 1e15"));
}

// The next tests check normals and colours.

/// Returns a triangle with further properties; `vertices` has those of each of its three vertices.
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
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("a face has a normal that is 0 or not a number")));
  EXPECT_THAT(validate(load_scene(folder_ / "scene.ply")), IsEmpty());
}

TEST_F(PlyTest, ColorsAreThoseOfScreens) {
  const auto colors = [](const std::string& type) {
    return "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
  };
  // In sRGB, the middle 8-bit value is a fifth of the full light.
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

TEST_F(PlyTest, ColorsThatLackAChannelAreWarnedOfOnce) {
  const std::string properties = "property uchar green\nproperty uchar blue\nproperty uchar alpha\n";
  const LoadedScene scene = load(triangle(properties, {"1 1 1", "1 1 1", "1 1 1"}));
  EXPECT_THAT(mesh_of(scene).colors, IsEmpty());
  EXPECT_THAT(scene.warnings, ElementsAre("colours of vertices are ignored because red, green or blue is missing"));
  EXPECT_THAT(load(triangle("property uchar alpha\n", {"1", "1", "1"})).warnings, IsEmpty());
}

TEST_F(PlyTest, ColorsOutOfRangeAreClamped) {
  const LoadedScene scene =
      load(triangle("property float red\nproperty float green\nproperty float blue\n", {"-1 2 nan", "0 0 0", "0 0 0"}));
  EXPECT_EQ(mesh_of(scene).colors.at(0), vec4(0, 1, 1, 1));
  EXPECT_THAT(scene.warnings, ElementsAre("line 15: a colour is not a number; 1 is used",
                                          "vertex colours below 0 or above 1 are clamped"));
}

TEST_F(PlyTest, WhatIsIgnoredIsSaid) {
  EXPECT_THAT(load(triangle("property float s\nproperty float t\n", {"0 0", "0 0", "0 0"})).warnings,
              ElementsAre("texture coordinates are ignored because no comment TextureFile names a picture"));
  EXPECT_THAT(load(triangle("", {"4", "", ""})).warnings,
              ElementsAre("numbers beyond the properties of an element are ignored"));
}

TEST_F(PlyTest, WordsThatAreNoNumbersCostWhatTheySay) {
  const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const LoadedScene colored = load(triangle(colors, {"x 0 0", "0 0 0", "0 0 0"}));
  EXPECT_EQ(mesh_of(colored).colors.at(0), vec4(1, 0, 0, 1));
  const LoadedScene smooth = load(triangle(kNormal, {"-1.#IND 0 x", "0 0 1", "0 0 1"}));
  EXPECT_THAT(mesh_of(smooth).normals, testing::Each(vec3(0, 0, 1)));
  EXPECT_THAT(smooth.warnings, ElementsAre(HasSubstr("the face is shaded flat")));
  EXPECT_THAT(load(triangle("property float quality\n", {"x", "y", "z"})).warnings, IsEmpty());
}

const std::string kFaceColor = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

TEST_F(PlyTest, FacesOfOtherColorsHaveVerticesOfTheirOwn) {
  const std::string file =
      text_header("element vertex 4\n" + kPlace + "element face 3\nproperty uchar blue\n" + kCornerList +
                  "property uchar flags\nproperty uchar green\nproperty uchar red\n") +
      kSquareRows + "0 3 0 1 2 7 0 255\n0 3 0 2 3 7 0 255\n255 4 0 1 2 3 7 0 0\n";
  const LoadedScene scene = load(file);
  const Mesh& mesh = mesh_of(scene);
  EXPECT_THAT(mesh.triangles, ElementsAre(uvec3(0, 1, 2), uvec3(0, 2, 3), uvec3(4, 5, 6), uvec3(4, 6, 7)))
      << "the red ones share theirs";
  EXPECT_THAT(corners_of(mesh),
              ElementsAre(vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0), vec3(1, 1, 0), vec3(0, 1, 0), vec3(0),
                          vec3(1, 0, 0), vec3(1, 1, 0), vec3(0), vec3(1, 1, 0), vec3(0, 1, 0)));
  const vec4 red(1, 0, 0, 1);
  const vec4 blue(0, 0, 1, 1);
  EXPECT_THAT(mesh.colors, ElementsAre(red, red, red, red, blue, blue, blue, blue));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(PlyTest, SharpFacesAndStripsKeepTheirColors) {
  const std::string file = text_header("element vertex 4\n" + kPlace + kNormal + "element tristrips 1\n" + kCornerList +
                                       "element face 2\n" + kFaceColor + kCornerList) +
                           "0 0 0 0 0 2\n1 0 0 0 0 2\n1 1 0 0 0 2\n0 1 0 0 0 0\n3 0 1 2\n255 0 0 3 0 1 2\n"
                           "0 255 0 3 0 2 3\n";
  const LoadedScene scene = load(file);
  const Mesh& mesh = mesh_of(scene);
  ASSERT_THAT(mesh.normals, SizeIs(9));
  ASSERT_THAT(mesh.colors, SizeIs(9));
  EXPECT_EQ(mesh.colors[mesh.triangles.at(0).x], vec4(1.0F));
  EXPECT_EQ(mesh.colors[mesh.triangles.at(1).x], vec4(1, 0, 0, 1));
  EXPECT_EQ(mesh.colors[mesh.triangles.at(2).x], vec4(0, 1, 0, 1));
  EXPECT_THAT(validate(load_scene(folder_ / "scene.ply")), IsEmpty());
}

/// A very large number of faces share one vertex, and each may have a different colour.
TEST_F(PlyTest, TimeStaysInBoundsWhereManyColorsMeet) {
  PlyBuilder ply(std::endian::little);
  const int count = 200'000;
  ply.header("element vertex 3\n" + kPlace + "element face " + std::to_string(count) + "\n" + kCornerList +
             "property ushort red\nproperty ushort green\nproperty ushort blue\n");
  for (const double number : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0}) ply.add("float", number);
  for (int i = 0; i < count; ++i) {
    ply.add("uchar", 3);
    for (const double corner : {0.0, 1.0, 2.0}) ply.add("int", corner);
    ply.add("ushort", i % 65536);
    for (const int rest : {i / 65536, 0}) ply.add("ushort", rest);
  }
  EXPECT_THAT(mesh_of(load(ply.bytes())).triangles, SizeIs(static_cast<size_t>(count)));
}

TEST_F(PlyTest, ColorsOfVerticesComeBeforeThoseOfFaces) {
  const std::string file =
      text_header("element vertex 3\n" + kPlace + kFaceColor + "element face 1\n" + kCornerList + kFaceColor) +
      "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2 0 0 255\n";
  const LoadedScene scene = load(file);
  EXPECT_THAT(mesh_of(scene).colors, testing::Each(vec4(1, 0, 0, 1)));
  EXPECT_THAT(scene.warnings, ElementsAre("colours of faces are ignored because the vertices have colours"));
}

// The next tests check textures.

/// The texture files lie in the test's folder.
class PlyTextureTest : public PlyTest {
 protected:
  PlyTextureTest() {
    const std::vector<std::byte> png = make_png({2, 1}, PNG_COLOR_TYPE_RGB, 8, {255, 0, 0, 0, 0, 255});
    for (const char* name : {"a.png", "b c.png"}) write(name, {reinterpret_cast<const char*>(png.data()), png.size()});
  }

  Scene load_textured(const std::string& file) const {
    write("scene.ply", file);
    return load_scene(folder_ / "scene.ply");
  }
};

const Mesh& only_mesh(const Scene& scene) {
  return std::get<Mesh>(scene.geometries.at(0));
}

TEST_F(PlyTextureTest, VerticesHaveTextureCoordinatesOfSeveralNames) {
  for (const auto& [u, v] : {std::pair("s", "t"), {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    const std::string names = std::string("property float ") + v + "\nproperty float " + u + "\n";
    const Scene scene = load_textured(triangle("comment TextureFile a.png\n" + names, {"0.25 0", "0 1", "1 0.5"}));
    EXPECT_THAT(only_mesh(scene).uvs, ElementsAre(vec4(0, 0.75F, 0, 0), vec4(1, 1, 0, 0), vec4(0.5F, 0, 0, 0))) << u;
    EXPECT_THAT(scene.warnings, IsEmpty());
    ASSERT_THAT(scene.materials, SizeIs(1));
    EXPECT_EQ(scene.materials[0].name, "a.png");
    EXPECT_EQ(scene.materials[0].phong().diffuse, vec3(1.0F));
    EXPECT_EQ(scene.materials[0].phong().diffuse_texture.texture, 0U);
    EXPECT_EQ(scene.images.at(0)->size, uvec2(2, 1));
    EXPECT_THAT(scene.images.at(0)->texels, SizeIs(2));
    EXPECT_EQ(scene.images.at(0)->use, ImageUse::kColor);
  }
}

TEST_F(PlyTextureTest, FacesHaveTextureCoordinatesAndTexturesOfTheirOwn) {
  const std::string file =
      text_header("comment TextureFile a.png\ncomment TextureFile b c.png\nelement vertex 4\n" + kPlace +
                  "property float s\nproperty float t\nelement face 5\nproperty int texnumber\n"
                  "property list uchar float texcoord\n" +
                  kCornerList) +
      "0 0 0 9 9\n1 0 0 9 9\n1 1 0 9 9\n0 1 0 9 9\n"
      "0 6 0 0 1 0 1 1 3 0 1 2\n0 6 0 0 1 1 0 0.5 3 0 2 3\n1 8 0 0 1 0 1 1 0 1 4 0 1 2 3\n"
      "-1 0 3 0 1 2\n1 4 0 0 1 1 3 0 1 2\n";
  const Scene scene = load_textured(file);
  const Mesh& mesh = only_mesh(scene);
  ASSERT_THAT(scene.materials, SizeIs(3));
  EXPECT_EQ(scene.materials[1].name, "b c.png");
  EXPECT_EQ(scene.materials[2].name, "default");
  EXPECT_THAT(mesh.triangle_materials, ElementsAre(0, 0, 1, 1, 2, 2));
  EXPECT_EQ(mesh.triangles.at(0), uvec3(0, 1, 2));
  EXPECT_EQ(mesh.triangles.at(1), uvec3(0, 2, 3)) << "corners with the same coordinates are shared";
  EXPECT_EQ(mesh.uvs.at(3), vec4(0, 0.5F, 0, 0));
  EXPECT_EQ(mesh.triangles.at(2), uvec3(0, 1, 2));
  EXPECT_THAT(
      scene.warnings,
      ElementsAre(
          "line 26: a face does not have two texture coordinates for each corner; it is drawn without a texture"));
  EXPECT_THAT(validate(scene), IsEmpty());
}

TEST_F(PlyTextureTest, BinaryFilesHaveThemInAnyOrder) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    PlyBuilder ply(order);
    ply.header("comment TextureFile a.png\nelement face 1\nproperty list int double texcoord\nproperty float red\n" +
               kCornerList +
               "property float blue\nproperty short texnumber\nproperty float green\n"
               "element vertex 3\nproperty float t\n" +
               kPlace);
    ply.add("int", 6);
    for (const double number : {0.0, 0.25, 0.5, 1.0, 0.75, 0.0}) ply.add("double", number);
    ply.add("float", 1);
    ply.add("uchar", 3);
    for (const double number : {2.0, 1.0, 0.0}) ply.add("int", number);
    ply.add("float", 0);
    ply.add("short", 0);
    ply.add("float", 1);
    for (int i = 0; i < 12; ++i) ply.add("float", i % 5);
    const Scene scene = load_textured(ply.bytes());
    EXPECT_THAT(only_mesh(scene).uvs, ElementsAre(vec4(0, 0.75F, 0, 0), vec4(0.5F, 0, 0, 0), vec4(0.75F, 1, 0, 0)));
    EXPECT_THAT(only_mesh(scene).colors, testing::Each(vec4(1, 1, 0, 1)));
    EXPECT_THAT(corners_of(only_mesh(scene)), ElementsAre(vec3(4, 0, 1), vec3(0, 1, 2), vec3(1, 2, 3)));
    EXPECT_THAT(scene.warnings, IsEmpty());
  }
}

TEST_F(PlyTextureTest, WhatCannotBeShownIsSaid) {
  const std::string uvs = "property float s\nproperty float t\n";
  const auto warnings = [&](const std::string& name, const std::string& properties, const std::string& values) {
    const Scene scene =
        load_textured(triangle("comment TextureFile " + name + "\n" + properties, {values, values, values}));
    EXPECT_EQ(scene.materials.at(0).name == "default", !only_mesh(scene).uvs.size()) << name;
    return scene.warnings;
  };
  EXPECT_THAT(warnings("none.png", uvs, "0 0"),
              ElementsAre(HasSubstr("a referenced file does not exist (\"none.png\")")));
  EXPECT_THAT(warnings("../none.png", uvs, "0 0"), ElementsAre(HasSubstr("leads out of the scene's folder")));
  EXPECT_THAT(warnings("C:\\scans\\a.png", uvs, "0 0"), IsEmpty()) << "a path of another machine";
  EXPECT_THAT(warnings("scene.ply", uvs, "0 0"), ElementsAre(HasSubstr("format is unknown")));
  EXPECT_THAT(warnings("a.png", "", ""), ElementsAre(HasSubstr("there are no texture coordinates")));
  EXPECT_THAT(warnings("a.png", uvs, "nan 0"),
              ElementsAre("line 15: a texture coordinate is beyond 1e15 or not finite, and 2 more; 0 is used"));
}

TEST_F(PlyTextureTest, ATextureThatIsNotThereIsNone) {
  const std::string file =
      text_header("comment TextureFile a.png\nelement vertex 3\n" + kPlace + "property float s\nproperty float t\n" +
                  "element face 2\n" + kCornerList + "property int texnumber\n") +
      "0 0 0 0 0\n1 0 0 0 0\n0 1 0 0 0\n3 0 1 2 1\n3 0 1 2 0\n";
  const Scene scene = load_textured(file);
  EXPECT_THAT(only_mesh(scene).triangle_materials, ElementsAre(1, 0));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("a face refers to a texture that does not exist")));
}

TEST_F(PlyTextureTest, SizesAreReadAloneWhereAskedFor) {
  write("scene.ply",
        triangle("comment TextureFile a.png\nproperty float s\nproperty float t\n", {"0 0", "0 0", "0 0"}));
  const Scene scene = load_scene(folder_ / "scene.ply", {.decodes_images = false});
  EXPECT_EQ(scene.images.at(0)->size, uvec2(2, 1));
  EXPECT_THAT(scene.images.at(0)->texels, IsEmpty());
}

// The next tests check refusals.

class BadPlyTest : public BadFileTest {};

TEST_P(BadPlyTest, IsRefusedWithPlaceAndCure) {
  expect_refusal("bad.ply", GetParam().text);
}

const std::string kVertexElement = "element vertex 4\n" + kPlace;

/// Returns the square's file as binary, up to its last face.
std::string cut_binary(const std::string& count_of_faces) {
  PlyBuilder ply(std::endian::little);
  ply.header(kVertexElement + "element face " + count_of_faces + "\n" + kCornerList);
  for (int i = 0; i < 12; ++i) ply.add("float", i % 5);
  ply.add("uchar", 3);
  for (const int corner : {0, 1}) ply.add("int", corner);
  return ply.bytes();
}

const BadFile kBadPly[] = {
    {"Empty", text_header("element vertex 0\n" + kPlace + "element face 0\n" + kCornerList), "scene.geometry.none", ""},
    {"SmallFacesAlone", square("2 0 1\n", 1), "scene.geometry.none corners", ""},
    {"NoPosition",
     text_header("element vertex 3\n" + kPlace + "element face 1\n" + kCornerList) + "0 0,5 0\n1 0 0\n0 1 0\n3 0 1 2\n",
     "ply.row.wrong \"0,5\"", ": line 12"},
    {"NoPly", "solid x\n", "ply.file.kind", ""},
    {"NoEnd", "ply\nformat ascii 1.0\nelement vertex 3\n", "ply.header.short", ": line 3"},
    {"NoFormat", "ply\nelement vertex 0\n" + kPlace + "end_header\n", "ply.header.format", ": line 6"},
    {"UnknownFormat", "ply\nformat binary 1.0\nend_header\n", "ply.header.format \"binary\"", ": line 2"},
    {"UnknownType", text_header("element vertex 3\nproperty half x\n"), "ply.header.type \"half\"", ": line 6"},
    {"UnknownListType", text_header("element face 3\nproperty list uchar long x\n"), "ply.header.type \"long\"",
     ": line 6"},
    {"NegativeCount", text_header("element vertex -1\n"), "ply.header.count \"-1\"", ": line 5"},
    {"NoCount", text_header("element vertex\n"), "ply.header.count \"\"", ": line 5"},
    {"TwoElements", text_header("element vertex 0\nelement vertex 0\n"), "ply.header.twice \"vertex\"", ": line 6"},
    {"TwoProperties", text_header("element vertex 0\nproperty int x\nproperty float x\n"), "ply.header.twice \"x\"",
     ": line 7"},
    {"PropertyOfNothing", text_header("property int x\n"), "ply.header.order", ": line 5"},
    {"NoVertices", text_header("element face 0\n" + kCornerList), "ply.vertices.missing \"vertex\"", ""},
    {"NoPositions", text_header("element vertex 0\nproperty float x\n"), "ply.vertices.missing x", ""},
    {"PointCloud", text_header(kVertexElement) + kSquareRows, "ply.faces.missing 4", ""},
    {"NoFaces", text_header(kVertexElement + "element face 0\n" + kCornerList) + kSquareRows, "ply.faces.missing", ""},
    {"FacesWithoutCorners", text_header(kVertexElement + "element face 1\nproperty int a\n") + kSquareRows + "1\n",
     "ply.faces.missing", ""},
    {"CountOfALie", text_header("element vertex 1000000000\n" + kPlace) + kSquareRows, "ply.file.short", ""},
    {"CountOfAHugeLie", text_header("element vertex 9223372036854775807\n" + kPlace) + kSquareRows, "ply.file.short",
     ""},
    {"CutBinaryHeader", cut_binary("1000"), "ply.file.short 1000 \"face\" 9", ""},
    {"CutBinary", cut_binary("1"), "ply.row.wrong list", ": face 0"},
    {"CutText", square("3 0 1 2\n", 2), "ply.row.wrong ends", ""},
    {"CutRow", square("3 0 1\n3 0 1 2\n", 2), "ply.row.wrong fewer", ": line 16"},
    {"NoNumber", square("3 0 1 x\n", 1), "ply.row.wrong \"x\"", ": line 16"},
    {"IndexPastTheEnd", square("3 0 1 4\n", 1), "ply.row.wrong vertex 4", ": line 16"},
    {"NegativeIndex", square("3 0 1 -1\n", 1), "ply.row.wrong vertex", ": line 16"},
    {"BrokenIndex", square("3 0 1 1.5\n", 1), "ply.row.wrong vertex", ": line 16"},
    {"CountOfNone", square("-3 0 1 2\n", 1), "ply.row.wrong list", ": line 16"},
    {"CountOfALong", square("99999999 0 1 2\n", 1), "ply.row.wrong list", ": line 16"},
    {"Nan",
     text_header("element vertex 3\n" + kPlace + "element face 1\n" + kCornerList) + "0 0 0\n0 nan 0\n1 0 0\n3 0 1 2\n",
     "scene.geometry.none vertex", ""},
    {"TooLarge",
     text_header("element vertex 3\n" + kPlace + "element face 1\n" + kCornerList) +
         "0 0 0\n0 1 0\n1e16 0 0\n3 0 1 2\n",
     "scene.geometry.none vertex 2", ""},
};

INSTANTIATE_TEST_SUITE_P(Table, BadPlyTest, testing::ValuesIn(kBadPly), name_of_bad_file);

TEST_F(PlyTest, TooManyCornersAreRefused) {
  std::string face = "10001";
  for (int i = 0; i < 10'001; ++i) face += i % 2 == 0 ? " 0" : " 1";
  EXPECT_THAT(refusal(square(face + "\n", 1)), HasProblem("ply.row.wrong 10000"));
}

}  // namespace
}  // namespace promin
