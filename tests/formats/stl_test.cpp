// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <limits>

#include "support/bad_file.h"
#include "support/scene_folder.h"
#include "support/stl_builder.h"

namespace promin {
namespace {

using testing::Contains;
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
  EXPECT_THAT(scene.warnings, ElementsAre("bytes behind the last facet are ignored"));
}

TEST_F(StlTest, WhatIsIgnoredIsSaid) {
  StlBuilder stl;
  stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}}, 0x801F);
  EXPECT_THAT(load(stl.bytes()).warnings, ElementsAre("colours of binary STL are ignored"));
  EXPECT_THAT(load("solid\ncolor 1 0 0\n" + kFacet + "endsolid\n").warnings,
              ElementsAre("1 statements of STL are ignored, the first is \"color\" in line 2"));
}

TEST_F(StlTest, WithoutFacetsThereIsNothingToShow) {
  for (const std::string& file : {StlBuilder().bytes(), std::string("solid x\nendsolid x\n")}) {
    const LoadedScene scene = load(file);
    EXPECT_THAT(scene.objects, IsEmpty());
    EXPECT_THAT(scene.warnings, Contains("the scene holds nothing to draw"));
  }
}

// Refusals

class BadStlTest : public BadFileTest {};

TEST_P(BadStlTest, IsRefusedWithPlaceAndCure) {
  expect_refusal("bad.stl", GetParam().text);
}

const BadFile kBadStl[] = {
    {"Short", "stl", "the file is no STL", ""},
    {"NoNumber", "solid\nfacet\nvertex 0 x 0\n", "\"x\" is no number up to 1e15", ": line 3"},
    {"TwoNumbers", "solid\nfacet\nvertex 0 0\n", "\"\" is no number up to 1e15", ": line 3"},
    {"TooLarge", "solid\nfacet\nvertex 0 0 1e16\n", "\"1e16\" is no number up to 1e15", ": line 3"},
    {"Nan", "solid\nfacet\nvertex 0 0 nan\n", "\"nan\" is no number", ": line 3"},
    {"TwoCorners", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 0\nendfacet\n", "a facet has 2 corners", ": line 5"},
    {"FourCorners", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nendfacet\n",
     "a facet has 4 corners", ": line 7"},
    {"LostVertex", "solid\nvertex 0 0 0\n", "lies in no facet", ": line 2"},
    {"LostEnd", "solid\nendfacet\n", "has no begin", ": line 2"},
    {"Nested", "solid\nfacet\nfacet\n", "within another", ": line 3"},
    {"Cut", "solid\nfacet\nvertex 0 0 0\n", "ends within a facet", ": line 3"},
};

INSTANTIATE_TEST_SUITE_P(Table, BadStlTest, testing::ValuesIn(kBadStl), name_of_bad_file);

TEST_F(StlTest, BrokenBinaryFilesSayWhy) {
  StlBuilder stl;
  for (int i = 0; i < 3; ++i) stl.add({{kTriangle[0], kTriangle[1], kTriangle[2]}});
  EXPECT_THAT(refusal(stl.bytes().substr(0, 200)), HasSubstr("tells of 3 facets and has room for 2"));
  EXPECT_THAT(refusal(std::string(100, '\xff')), HasSubstr("tells of 4294967295 facets and has room for 0"));
  stl.add({{kTriangle[0], {0, std::numeric_limits<float>::quiet_NaN(), 0}, kTriangle[2]}});
  const std::string message = refusal(stl.bytes());
  EXPECT_THAT(message, HasSubstr("not finite or beyond 1e15"));
  EXPECT_THAT(message, HasSubstr("scene.stl: facet 3"));
}

}  // namespace
}  // namespace promin
