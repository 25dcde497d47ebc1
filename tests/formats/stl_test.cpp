// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/srgb.h"
#include "support/bad_file.h"
#include "support/scene_folder.h"
#include "support/stl_builder.h"

namespace promin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::string kFacet =
    "  facet normal 0 0 -1\n    outer loop\n      vertex 0 0 0\n      vertex 1 0 0\n      vertex 0 1e0 +0.0\n"
    "    endloop\n  endfacet\n";
const std::vector<vec3> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

class StlTest : public SceneFolder {
 protected:
  LoadedScene load(std::string_view file) const { return SceneFolder::load("scene.stl", file); }
  std::string refusal(std::string_view file) const { return SceneFolder::refusal("scene.stl", file); }
};

TEST_F(StlTest, TextIsRead) {
  const LoadedScene scene = load("solid part\n" + kFacet + "endsolid part\n");
  ASSERT_THAT(scene.objects, SizeIs(1));
  EXPECT_EQ(scene.objects[0].name, "part");
  EXPECT_EQ(corners_of(mesh_of(scene)), kTriangle);
  EXPECT_THAT(mesh_of(scene).normals, IsEmpty()) << "the file's normals are not taken";
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.materials, SizeIs(1));
  EXPECT_EQ(scene.materials[0].phong().diffuse, vec3(0.8F));
  EXPECT_FALSE(load_scene(folder_ / "scene.stl").is_classic);
}

TEST_F(StlTest, CaseAndLineEndsDoNotMatter) {
  std::string text = "\n SOLID Part\n" + kFacet + "ENDSOLID\n";
  std::transform(text.begin(), text.end(), text.begin(), [](char c) { return c >= 'a' && c <= 'z' ? c - 32 : c; });
  EXPECT_EQ(corners_of(mesh_of(load(with_carriage_returns(text)))), kTriangle);
}

TEST_F(StlTest, AByteOrderMarkDoesNotHideAText) {
  EXPECT_EQ(corners_of(mesh_of(load("\xEF\xBB\xBFsolid part\n" + kFacet + "endsolid part\n"))), kTriangle);
}

TEST_F(StlTest, SolidsWithFacetsAreNumbered) {
  const LoadedScene scene =
      load("solid first one\n" + kFacet + kFacet + "endsolid\nsolid empty\nendsolid\nsolid\n" + kFacet + "endsolid\n");
  ASSERT_THAT(scene.objects, SizeIs(2));
  EXPECT_EQ(scene.objects[0].name, "first one");
  EXPECT_THAT(mesh_of(scene, 0).triangles, SizeIs(2));
  EXPECT_EQ(scene.objects[1].name, "");
  EXPECT_THAT(mesh_of(scene, 1).triangles, SizeIs(1));
}

TEST_F(StlTest, FacetsKeepTheirCornersAndNumbers) {
  StlBuilder stl;
  stl.add({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  stl.add({{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}}});
  stl.add({{{1, 0, 0}, {0, 1, 0}, {1, 1, -2.5F}}});
  const LoadedScene scene = load(stl.bytes());
  const Mesh& mesh = mesh_of(scene);
  EXPECT_THAT(mesh.positions, SizeIs(9)) << "equal corners are not merged";
  EXPECT_THAT(mesh.triangles, ElementsAre(uvec3(0, 1, 2), uvec3(3, 4, 5), uvec3(6, 7, 8)));
  EXPECT_EQ(mesh.positions.back(), vec3(1, 1, -2.5F));
  EXPECT_TRUE(world::is_degenerate(mesh, 1));
  EXPECT_THAT(mesh.normals, IsEmpty());
  EXPECT_EQ(scene.objects[0].name, "");
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(StlTest, ABinaryFileMayBeginAsATextDoes) {
  StlBuilder stl("solid of some program, and spaces up to the end of the header, as some exporters write it ");
  stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}});
  EXPECT_EQ(corners_of(mesh_of(load(stl.bytes()))), kTriangle);
  StlBuilder longer("solid");
  longer.add({{kTriangle[0], kTriangle[1], kTriangle[2]}});
  const LoadedScene scene = load(longer.bytes() + "tail");
  EXPECT_EQ(corners_of(mesh_of(scene)), kTriangle) << "zeros in its header tell it";
  EXPECT_THAT(scene.warnings, ElementsAre("bytes after the last facet are ignored"));
}

TEST_F(StlTest, WhatIsIgnoredIsSaid) {
  StlBuilder stl;
  stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}}, 0x001F);
  EXPECT_THAT(load(stl.bytes()).warnings, ElementsAre("the bytes after each facet are not colours and are ignored"));
  EXPECT_THAT(load("solid\ncolor 1 0 0\n" + kFacet + "endsolid\n").warnings,
              ElementsAre("1 statements of STL are ignored, the first is \"color\" in line 2"));
}

TEST_F(StlTest, LinesMeanNothing) {
  const std::string text = "solid a part\n" + kFacet + kFacet + "endsolid a part\nsolid\n" + kFacet + "endsolid\n";
  for (const char end : {' ', '\t', '\r'}) {
    std::string other = text;
    std::ranges::replace(other, '\n', end);
    const LoadedScene scene = load(other);
    ASSERT_THAT(scene.objects, SizeIs(2)) << int{end};
    EXPECT_EQ(scene.objects[0].name, "a part");
    EXPECT_THAT(mesh_of(scene, 0).triangles, SizeIs(2));
    EXPECT_EQ(corners_of(mesh_of(scene, 1)), kTriangle);
    EXPECT_THAT(scene.warnings, IsEmpty());
  }
  std::string words = "solid\n" + kFacet;
  std::ranges::replace(words, ' ', '\n');
  EXPECT_EQ(corners_of(mesh_of(load(words))), kTriangle);
}

TEST_F(StlTest, NamesMayHoldWordsOfTheFormat) {
  const LoadedScene scene = load("solid a facet of vertex #2\n" + kFacet + "endsolid a facet of vertex #2\nsolid  \n" +
                                 kFacet + "endsolid solid\n");
  ASSERT_THAT(scene.objects, SizeIs(2));
  EXPECT_EQ(scene.objects[0].name, "a facet of vertex #2");
  EXPECT_EQ(scene.objects[1].name, "");
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(StlTest, NormalsMayBeAnything) {
  for (const char* normal : {" nan nan nan", " 1.#QNAN 0 0", " x", "", " 0 0", "\n0 0\n-1"}) {
    const LoadedScene scene = load("solid\nfacet normal" + std::string(normal) +
                                   "\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n");
    EXPECT_EQ(corners_of(mesh_of(scene)), kTriangle) << normal;
    EXPECT_THAT(scene.warnings, IsEmpty()) << normal;
  }
}

TEST_F(StlTest, ZeroBytesBehindATextAreCutOff) {
  const std::string small = "solid facet vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endfacet";
  EXPECT_EQ(corners_of(mesh_of(load(small + std::string(3, '\0')))), kTriangle);
}

TEST_F(StlTest, FacetsThatAreNoTrianglesAreSaid) {
  const std::string begin = "facet normal 0 0 1\nvertex 0 0 0\nvertex 1 0 0\n";
  const LoadedScene scene =
      load("solid\n" + begin + "endfacet\n" + begin + "vertex 1 1 0\nvertex 0 1 0\nendfacet\n" + begin +
           "vertex 0 nan inf\nendfacet\n" + begin + "vertex 0 1e16 0\nendfacet\n" + kFacet);
  EXPECT_THAT(mesh_of(scene).triangles, SizeIs(3)) << "two of the square";
  EXPECT_THAT(scene.warnings, ElementsAre("line 5: a facet has fewer than 3 corners (2); promin omits the facet",
                                          "line 11: a facet has more than 3 corners (4); it is divided into triangles",
                                          "line 15: a facet has a vertex coordinate that is not a number up to 1e15 "
                                          "(\"nan\"), and 1 more; promin omits the facet"));
  EXPECT_THROW(load_scene(folder_ / "scene.stl", {.is_strict = true}), InputError);
}

TEST_F(StlTest, BinaryFacetsWithoutAPlaceAreLeftOut) {
  StlBuilder stl;
  stl.add({{kTriangle[0], {0, std::numeric_limits<float>::quiet_NaN(), 0}, kTriangle[2]}}, 0x8001);
  stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}}, 0xFC00);
  stl.add({{kTriangle[0], {0, 0, 2e15F}, kTriangle[2]}});
  const LoadedScene scene = load(stl.bytes());
  EXPECT_EQ(corners_of(mesh_of(scene)), kTriangle);
  EXPECT_THAT(mesh_of(scene).colors, testing::Each(vec4(1, 0, 0, 1))) << "that of its facet";
  EXPECT_THAT(scene.warnings, ElementsAre("facet 0: a facet has a vertex coordinate that is not a number up to 1e15, "
                                          "and 1 more; promin omits the facet"));
}

TEST_F(StlTest, ACountThatWasNeverWrittenIsThatOfTheSize) {
  for (const uint32_t count : {0U, 0xFFFFFFFFU}) {
    StlBuilder stl("solid of a pipe");
    for (int i = 0; i < 3; ++i) stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}});
    std::string bytes = stl.bytes();
    std::memcpy(bytes.data() + 80, &count, sizeof(count));
    const LoadedScene scene = load(bytes);
    EXPECT_THAT(mesh_of(scene).triangles, SizeIs(3));
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("the number of facets is missing")));
    EXPECT_THROW(load_scene(folder_ / "scene.stl", {.is_strict = true}), InputError);
    // If the size does not show which format it is, the file is refused.
    EXPECT_THAT(refusal(bytes + "x"),
                testing::AnyOf(HasProblem("scene.geometry.none"), HasProblem("stl.file.short 3")));
  }
}

/// Returns the light of a colour's 5-bit code.
float light_of(int code) {
  return static_cast<float>(srgb_to_linear(code / 31.0));
}

TEST_F(StlTest, ColorsAreThoseOfVisCam) {
  StlBuilder stl;
  for (const uint16_t attribute : {0x8000 | 31 << 10 | 16 << 5 | 1, 0x8000, 31 << 10}) {
    stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}}, attribute);
  }
  const LoadedScene scene = load(stl.bytes());
  const std::vector<vec4>& colors = mesh_of(scene).colors;
  ASSERT_THAT(colors, SizeIs(9));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(colors[i], vec4(1, light_of(16), light_of(1), 1)) << "red is high";
    EXPECT_EQ(colors[3 + i], vec4(0, 0, 0, 1));
    EXPECT_EQ(colors[6 + i], vec4(1, 1, 1, 1)) << "it has no own colour";
  }
  EXPECT_THAT(scene.warnings, IsEmpty());
  StlBuilder plain;
  plain.add({{kTriangle[0], kTriangle[1], kTriangle[2]}});
  EXPECT_THAT(mesh_of(load(plain.bytes())).colors, IsEmpty());
}

TEST_F(StlTest, ColorsAreThoseOfMagics) {
  const std::string header = "made by a program, COLOR=\xFF" + std::string(1, '\0') + "\x80\xFF,MATERIAL=";
  StlBuilder stl(header);
  stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}}, 31 | 16 << 5 | 1 << 10);
  stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}}, 0xFFFF);
  const LoadedScene scene = load(stl.bytes());
  const vec4 color_of_object(1, 0, static_cast<float>(srgb_to_linear(128.0 / 255.0)), 1);
  ASSERT_THAT(mesh_of(scene).colors, SizeIs(6));
  EXPECT_EQ(mesh_of(scene).colors[0], vec4(1, light_of(16), light_of(1), 1)) << "red is low";
  EXPECT_EQ(mesh_of(scene).colors[3], color_of_object);
  StlBuilder uniform(header);
  uniform.add({{kTriangle[0], kTriangle[1], kTriangle[2]}});
  EXPECT_THAT(mesh_of(load(uniform.bytes())).colors, testing::Each(color_of_object)) << "no facet has a colour";
}

TEST_F(StlTest, WithoutFacetsThereIsNothingToShow) {
  for (const std::string& file : {StlBuilder().bytes(), std::string("solid x\nendsolid x\n")}) {
    EXPECT_THAT(refusal(file), HasProblem("scene.geometry.none"));
  }
}

// The next tests check refusals.

class BadStlTest : public BadFileTest {};

TEST_P(BadStlTest, IsRefusedWithPlaceAndCure) {
  expect_refusal("bad.stl", GetParam().text);
}

const BadFile kBadStl[] = {
    {"Short", "stl", "stl.file.kind", ""},
    {"NoNumber", "solid\nfacet\nvertex 0 x 0\n", "stl.number.wrong \"x\"", ": line 3"},
    {"TwoNumbers", "solid\nfacet\nvertex 0 0\nendloop\n", "stl.number.wrong \"endloop\"", ": line 4"},
    {"TooLarge", "solid\nfacet\nvertex 0 0 1e16\nvertex 0 0 0\nvertex 1 1 1\nendfacet\n",
     "scene.geometry.none \"1e16\" line 3", ""},
    {"TwoCorners", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 0\nendfacet\n", "scene.geometry.none corners line 5", ""},
    {"LostVertex", "solid\nvertex 0 0 0\n", "stl.facet.nested", ": line 2"},
    {"LostEnd", "solid\nendfacet\n", "stl.facet.nested", ": line 2"},
    {"Nested", "solid\nfacet\nfacet\n", "stl.facet.nested", ": line 3"},
    {"Cut", "solid\nfacet\nvertex 0 0 0\n", "stl.file.short", ": line 3"},
};

INSTANTIATE_TEST_SUITE_P(Table, BadStlTest, testing::ValuesIn(kBadStl), name_of_bad_file);

TEST_F(StlTest, BrokenBinaryFilesSayWhy) {
  StlBuilder stl;
  for (int i = 0; i < 3; ++i) stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}});
  EXPECT_THAT(refusal(stl.bytes().substr(0, 200)), HasProblem("stl.file.short 3 2"));
  EXPECT_THAT(refusal(std::string(100, '\xff')), HasProblem("stl.file.short 4294967295 0"));
}

}  // namespace
}  // namespace promin
