// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "core/utf8.h"
#include "formats/source_file.h"
#include "formats/triangulate.h"
#include "support/bad_file.h"
#include "support/make_png.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class ObjTest : public SceneFolder {
 protected:
  LoadedScene load(std::string_view text) const { return SceneFolder::load("scene.obj", text); }
  std::string refusal(std::string_view text) const { return SceneFolder::refusal("scene.obj", text); }

  /// The material "m" of an MTL with these lines.
  Material material(const std::string& lines, std::vector<std::string>* warnings = nullptr) const {
    write("m.mtl", "newmtl m\n" + lines);
    const LoadedScene scene = load(kSquare + "mtllib m.mtl\nusemtl m\nf 1 2 3\n");
    if (warnings != nullptr) *warnings = scene.warnings;
    return scene.materials.at(scene.objects.at(0).material);
  }
};

TEST_F(ObjTest, TellsOfItsFilesAsTheyWereBeforeReading) {
  write("m.mtl", "newmtl m\n");
  write("scene.obj", kSquare + "mtllib m.mtl\nmtllib missing.mtl\nf 1 2 3\n");
  const auto names_of = [](const std::vector<SourceFile>& sources) {
    std::vector<std::string> names;
    for (const SourceFile& source : sources) names.push_back(source.file.filename().string());
    return names;
  };
  std::vector<SourceFile> sources;
  load_scene(folder_ / "scene.obj", {}, sources);
  ASSERT_THAT(names_of(sources), ElementsAre("scene.obj", "m.mtl", "missing.mtl"));
  for (const SourceFile& source : sources) EXPECT_EQ(source.stamp, stamp_of(source.file));
  EXPECT_TRUE(sources[1].stamp);
  EXPECT_FALSE(sources[2].stamp);
  write("m.mtl", "newmtl n\nKd 1 1 1\n");
  EXPECT_NE(sources[1].stamp, stamp_of(sources[1].file));

  write("scene.obj", kSquare + "mtllib m.mtl\nf 1 2 300\n");
  EXPECT_THROW(load_scene(folder_ / "scene.obj", {}, sources), InputError);
  EXPECT_THAT(names_of(sources), Contains("scene.obj")) << "also of a broken scene";
}

// Faces

TEST_F(ObjTest, FacesCountFromTheFrontOrTheBack) {
  const std::vector<vec3> wanted = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  EXPECT_EQ(corners_of(mesh_of(load(kSquare + "f 1 2 3"))), wanted);
  EXPECT_EQ(corners_of(mesh_of(load(kSquare + "f -4 -3 -2\n"))), wanted);
  EXPECT_EQ(corners_of(mesh_of(load("f 1 2 3\n" + kSquare))), wanted) << "vertices may follow";
  EXPECT_EQ(corners_of(mesh_of(load(kSquare + "f 1/7 2/8 3/9 # no texture shows these\n"))), wanted);
}

TEST_F(ObjTest, LineEndsOfEveryKindWork) {
  EXPECT_THAT(mesh_of(load("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n")).triangles, SizeIs(1));
  EXPECT_THAT(mesh_of(load("\tv  0\t0 0 \nv +1 0 0\nv 0 1e0 0#c\n\n  f 1 2 3")).triangles, SizeIs(1));
}

// As editors of Windows write it; the first line would be no statement with it.
TEST_F(ObjTest, AByteOrderMarkIsNoPartOfTheFirstLine) {
  const LoadedScene scene = load("\xEF\xBB\xBF" + kSquare + "f 1 2 3\n");
  EXPECT_THAT(mesh_of(scene).triangles, SizeIs(1));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(ObjTest, PolygonsAreCutIntoTriangles) {
  EXPECT_THAT(mesh_of(load(kSquare + "f 1 2 3 4\n")).triangles, ElementsAre(uvec3(0, 1, 2), uvec3(0, 2, 3)));
}

TEST_F(ObjTest, ObjectsAndGroupsWithFacesAreNumbered) {
  const LoadedScene scene =
      load(kSquare + "f 1 2 3\no empty\no first\ng second\nf 1 2 3\nf 1 3 4\ng\no  third one \nf 2 3 4\n");
  std::vector<std::string> names;
  std::vector<uint32_t> counts;
  for (const world::Object& object : scene.objects) {
    names.push_back(object.name);
    counts.push_back(primitive_count(object.shape));
  }
  EXPECT_THAT(names, ElementsAre("", "second", "third one"));
  EXPECT_THAT(counts, ElementsAre(1, 2, 1));
  EXPECT_THAT(mesh_of(scene, 2).positions, SizeIs(3)) << "each object keeps its own vertices";
}

TEST_F(ObjTest, StatementsGoOnBehindABackslash) {
  const LoadedScene scene =
      load("v 0 0 \\\n0\nv 1\\\r\n 0 \\\n 0\nv 0 1 0\n# in C:\\scenes\\\no name\nf 1 \\\n2 3\nv 0 0 1\\");
  EXPECT_THAT(mesh_of(scene).triangles, ElementsAre(uvec3(0, 1, 2)));
  EXPECT_EQ(mesh_of(scene).positions.at(1), vec3(1, 0, 0));
  EXPECT_EQ(scene.objects.at(0).name, "name");
}

// In Latin-1, as older programs write them. What quotes them is UTF-8 too, wherever a quoted word is cut.
TEST_F(ObjTest, NamesAreShownInUtf8) {
  write("latin.mtl", "newmtl m\xFCller\n");
  const LoadedScene scene =
      load("mtllib latin.mtl\no caf\xE9\n" + kSquare + "usemtl m\xFCller\nf 1 2 3\no Kaffee für alle\nf 1 2 3\n");
  EXPECT_EQ(scene.objects.at(0).name, "caf\uFFFD");
  EXPECT_EQ(scene.objects.at(1).name, "Kaffee für alle");
  EXPECT_EQ(scene.materials.at(scene.objects[0].material).name, "m\uFFFDller");
  for (std::string word : {"", "x"}) {
    while (word.size() < 100) word += "ü";
    const std::string said = refusal("f " + word + "\n");
    EXPECT_THAT(said, HasSubstr("is no corner"));
    EXPECT_EQ(said, to_utf8(said));
  }
}

TEST_F(ObjTest, DegenerateTrianglesKeepTheirNumber) {
  const LoadedScene scene = load(kSquare + "f 1 1 2\nf 1 2 3\n");
  EXPECT_THAT(mesh_of(scene).triangles, SizeIs(2));
  EXPECT_TRUE(world::is_degenerate(mesh_of(scene), 0));
  EXPECT_FALSE(world::is_degenerate(mesh_of(scene), 1));
}

TEST_F(ObjTest, NormalsHaveIndicesOfTheirOwn) {
  const LoadedScene scene = load(kSquare + "vn 0 0 2\nvn 0 3 0\nf 1//1 2//1 3//1\nf 1/9/1 3//2 4//-2\n");
  const Mesh& mesh = mesh_of(scene);
  EXPECT_THAT(mesh.positions, SizeIs(5)) << "vertex 3 has two normals, vertex 1 one";
  EXPECT_EQ(mesh.normals.at(mesh.triangles[0].z), vec3(0, 0, 1));
  EXPECT_EQ(mesh.normals.at(mesh.triangles[1].y), vec3(0, 1, 0));
  EXPECT_EQ(mesh.triangles[0].x, mesh.triangles[1].x);
}

TEST_F(ObjTest, FacesWithoutNormalsAreSharp) {
  EXPECT_THAT(mesh_of(load(kSquare + "s 1\nf 1 2 3\n")).normals, IsEmpty());
  const LoadedScene mixed = load(kSquare + "vn 1 0 0\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1 3 4\nf 1//1 3//2 4//1\n");
  const Mesh& mesh = mesh_of(mixed);
  EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_EQ(mesh.normals.at(mesh.triangles[0].x), vec3(1, 0, 0));
  for (const size_t sharp : {1, 2}) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(mesh.normals.at(mesh.triangles[sharp][i]), vec3(0, 0, 1));
  }
  EXPECT_THAT(mixed.warnings, ElementsAre(HasSubstr("no length")));
}

TEST_F(ObjTest, VertexColorsFollowThePosition) {
  const LoadedScene scene = load("v 0 0 0\nv 1 0 0 0.5 0.25 1\nv 0 1 0 1.0\nf 1 2 3\n");
  EXPECT_THAT(mesh_of(scene).colors, ElementsAre(vec4(1), vec4(0.5F, 0.25F, 1, 1), vec4(1)));
  EXPECT_THAT(mesh_of(load(kSquare + "f 1 2 3\n")).colors, IsEmpty());
}

TEST_F(ObjTest, WhatIsNotDrawnIsSaidOnce) {
  EXPECT_THAT(load(kSquare + "f 1 2 3\nl 1 2\np 1\nl 2 3\n").warnings, ElementsAre("lines and points are not drawn"));
  EXPECT_THAT(load(kSquare + "f 1 2 3\nvp 1 2\ncurv 0 1 1 2\n").warnings,
              ElementsAre("2 statements of OBJ are ignored, the first is \"vp\" in line 6"));
}

TEST_F(ObjTest, WithoutFacesThereIsNothingToShow) {
  EXPECT_THAT(refusal(kSquare), HasSubstr("4 vertices but no face that can be drawn"));
  EXPECT_THAT(refusal(kSquare + "l 1 2\np 1\n"), HasSubstr("(lines and points are not drawn)"));
  EXPECT_THAT(refusal(kSquare + "f 1 2\n"),
              HasSubstr("(a face has fewer than 3 corners, line 5; the face is left out)"));
  EXPECT_THAT(refusal("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), HasSubstr("no face that can be drawn (a face has"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("0 vertices but no face"));
}

// What costs no geometry

TEST_F(ObjTest, LinesMayEndInAnyWay) {
  const auto with_ends = [](std::string lines, const std::string& end) {
    for (size_t at = lines.find('\n'); at != std::string::npos; at = lines.find('\n', at + end.size())) {
      lines.replace(at, 1, end);
    }
    return lines;
  };
  for (const std::string end : {"\n", "\r", "\r\n"}) {
    write("m.mtl", with_ends("newmtl other\nKd 1 1 1\nnewmtl m\nKd 0.5 0.25 0\n", end));
    const LoadedScene scene =
        load(with_ends("# a comment\n" + kSquare + "mtllib m.mtl\nusemtl m\nf 1 2 \\\n3\nf 1 3 4", end));
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_THAT(mesh_of(scene).positions, ElementsAre(vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)));
    EXPECT_THAT(mesh_of(scene).triangles, SizeIs(2));
    EXPECT_EQ(scene.materials.at(0).phong().diffuse, vec3(0.5F, 0.25F, 0));
  }
  EXPECT_THAT(refusal("v 0 0 0\rv 1 0 0\r\nv 0 1 0\nf 1 2 9\r"), HasSubstr(": line 4")) << "lines are counted alike";
}

TEST_F(ObjTest, ZeroBytesAtTheEndDoNotCount) {
  EXPECT_THAT(mesh_of(load(kSquare + "f 1 2 3\n" + std::string(3, '\0'))).triangles, SizeIs(1));
}

TEST_F(ObjTest, FacesOfFewerThanThreeCornersAreLeftOut) {
  const LoadedScene scene = load(kSquare + "f 1 2\nf 1 2 3 4\nf\nf 3\no last\nf 1 2\n");
  EXPECT_THAT(scene.objects, SizeIs(1));
  EXPECT_THAT(mesh_of(scene).triangles, SizeIs(2)) << "the square has the numbers 0 and 1";
  EXPECT_THAT(scene.warnings, ElementsAre("a face has fewer than 3 corners, line 5 and 3 more; the face is left out"));
}

TEST_F(ObjTest, VerticesThatNoFaceUsesMayHoldAnything) {
  const LoadedScene scene = load("v nan 0 0\nv 1\nv 1e99 x y\nv 1e16 0 0\n" + kSquare + "f -4 -3 -2\n");
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(mesh_of(scene).positions, ElementsAre(vec3(0), vec3(1, 0, 0), vec3(1, 1, 0)));
}

TEST_F(ObjTest, FacesOfVerticesWithoutPlaceAreLeftOut) {
  const LoadedScene scene =
      load("o a\nf 1 2 3\no b\nf 5 1 2\nf 1 3 4\nf 6 5 1\n" + kSquare + "v 0 -inf 0\nv 0,5 1 2\n");
  ASSERT_THAT(scene.objects, SizeIs(2));
  EXPECT_THAT(mesh_of(scene, 1).triangles, SizeIs(1));
  EXPECT_THAT(scene.warnings, ElementsAre("a face has a vertex coordinate that is no number up to 1e15, line 11 and 1 "
                                          "more; the face is left out"));
  EXPECT_THAT(load("o a\nf 5 1 2\no b\nf 1 2 3\n" + kSquare + "v 1 2\n").objects, SizeIs(1)) << "no empty object";
}

TEST_F(ObjTest, BadNormalsMakeFacesSharp) {
  const std::string normals = "vn 0 0 1\nvn nan 0 1\nvn 0 1\nvn 0 0 0\nvn 1e16 0 0\n";
  EXPECT_THAT(load(normals + kSquare + "f 1//1 2//1 3//1\n").warnings, IsEmpty()) << "no face uses the bad ones";
  for (const std::string bad : {"2", "3", "4", "5"}) {
    const std::string corners = "f 1//1 2//1 3//" + bad + "\n";
    const LoadedScene scene = load(normals + kSquare + corners + corners + "f 1//1 3//1 4//1\n");
    EXPECT_THAT(mesh_of(scene).normals, Each(vec3(0, 0, 1)));
    EXPECT_THAT(scene.warnings, ElementsAre("a face has a normal of no length, or one that is no number, normal " +
                                            bad + " and 1 more; the face is drawn sharp"));
    EXPECT_THAT(mesh_of(load(normals + kSquare + corners)).normals, IsEmpty());
  }
  for (const std::string bad : {"6", "-6", "0", "99999999999", "x"}) {
    const LoadedScene scene = load(normals + kSquare + "f 1//1 2//1 3//" + bad + "\n");
    EXPECT_THAT(mesh_of(scene).normals, IsEmpty());
    EXPECT_THAT(scene.warnings,
                ElementsAre("a face names a normal that is not there, face 1; the face is drawn sharp"));
  }
  EXPECT_THAT(mesh_of(load(kSquare + "f 1//1 2//2 3//3\n")).triangles, SizeIs(1)) << "a file without normals";
}

TEST_F(ObjTest, ColorsCostAWarningAtMost) {
  const auto color = [&](const std::string& numbers, std::vector<std::string>& warnings) {
    const LoadedScene scene = load("v 0 0 0 " + numbers + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    warnings = scene.warnings;
    return mesh_of(scene).colors.empty() ? vec3(-1) : vec3(mesh_of(scene).colors[0]);
  };
  std::vector<std::string> warnings;
  EXPECT_EQ(color("0.5 0.25 1 0.75", warnings), vec3(0.5F, 0.25F, 1)) << "with an alpha";
  EXPECT_THAT(warnings, IsEmpty());
  EXPECT_EQ(color("0.5 nan 1", warnings), vec3(1));
  EXPECT_THAT(warnings, ElementsAre("a vertex colour is no number, line 1; the vertex is white"));
  EXPECT_EQ(color("0.5 -1 1", warnings), vec3(0.5F, 0, 1));
  EXPECT_THAT(warnings, ElementsAre("a vertex colour is negative, line 1; it counts as 0"));
  EXPECT_EQ(color("0.5 1", warnings), vec3(-1));
  EXPECT_THAT(warnings, ElementsAre("a vertex has 5 numbers, line 1; x y z count"));
}

TEST_F(ObjTest, StatementsOfMaterialsMayBeBad) {
  std::vector<std::string> warnings;
  const Material m =
      material("Kd spectral red.rfl\nKs nan 0 0\nKe 0,5 1 1\nKa -0.5 0.25 1e20\nNs x\nKd xyz 1 2 3\n", &warnings);
  EXPECT_EQ(m.phong().diffuse, vec3(0.8F));
  EXPECT_EQ(m.phong().specular, vec3(0));
  EXPECT_EQ(m.emissive, vec3(0));
  EXPECT_EQ(m.phong().ambient, vec3(0, 0.25F, 1e15F));
  EXPECT_EQ(m.phong().shininess, 0.0F);
  EXPECT_THAT(warnings,
              ElementsAre("Kd has a word that is no number (\"spectral\"), mtllib m.mtl line 2 and 1 more; the "
                          "statement is left out",
                          "Ks has a word that is no number (\"nan\"), mtllib m.mtl line 3; the statement is "
                          "left out",
                          "Ke has a word that is no number (\"0,5\"), mtllib m.mtl line 4; the statement is "
                          "left out",
                          "Ka is negative or beyond 1e15 (\"-0.5\"), mtllib m.mtl line 5 and 1 more; it is "
                          "clamped",
                          "Ns has a word that is no number (\"x\"), mtllib m.mtl line 6; the statement is "
                          "left out"));
}

TEST_F(ObjTest, TrIsTransparencyUnlessItWouldHideAll) {
  std::vector<std::string> warnings;
  EXPECT_EQ(material("Tr 0.25\n", &warnings).alpha, 0.75F);
  EXPECT_THAT(warnings, IsEmpty());
  const Material opaque = material("Tr 1\n", &warnings);
  EXPECT_EQ(opaque.alpha, 1.0F);
  EXPECT_EQ(opaque.alpha_mode, AlphaMode::kOpaque);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("has a Tr of 1 and no d, it is drawn opaque")));
  EXPECT_EQ(material("Tr 1\nd 0.5\n", &warnings).alpha, 0.5F);
  EXPECT_THAT(warnings, IsEmpty());
  EXPECT_EQ(material("d 0\n", &warnings).alpha, 0.0F);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("has a d of 0, it is invisible")));
}

TEST_F(ObjTest, NamesMayHaveCommentsBehindThem) {
  write("a.mtl", "newmtl red # paint\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nnewmtl no # comment\nKd 0 1 0\n");
  const auto diffuse_of = [&](const std::string& use) {
    const LoadedScene scene = load(kSquare + "mtllib a.mtl # colours\nusemtl " + use + "\nf 1 2 3\n");
    EXPECT_THAT(scene.warnings, IsEmpty()) << use;
    return scene.materials.at(0).phong().diffuse;
  };
  EXPECT_EQ(diffuse_of("red"), vec3(1, 0, 0));
  EXPECT_EQ(diffuse_of("blue # as the sky"), vec3(0, 0, 1));
  EXPECT_EQ(diffuse_of("no # comment"), vec3(0, 1, 0));
}

TEST_F(ObjTest, PathsOfOtherMachinesLeadToTheFileBeside) {
  write("m.mtl", "newmtl m\nKd 1 0 0\n");
  for (const std::string name : {"C:\\models\\m.mtl", "/home/x/m.mtl", "../m.mtl", "file:///m.mtl", "sub/m.mtl"}) {
    const LoadedScene scene = load(kSquare + "mtllib " + name + "\nusemtl m\nf 1 2 3\n");
    EXPECT_THAT(scene.warnings, IsEmpty()) << name;
    EXPECT_EQ(scene.materials.at(0).phong().diffuse, vec3(1, 0, 0)) << name;
  }
  const LoadedScene grey = load(kSquare + "mtllib /etc/passwd\nusemtl m\nf 1 2 3\n");
  EXPECT_THAT(grey.warnings, Contains(HasSubstr("the material file \"/etc/passwd\" does not exist")));
  EXPECT_EQ(grey.materials.at(0).phong().diffuse, vec3(0.8F));
}

TEST_F(ObjTest, StrictLoadsRefuseWhatIsRepaired) {
  write("nan.mtl", "newmtl m\nKd nan 0 0\n");
  for (const std::string bad : {"f 1 2\n", "v nan 0 0\nf 1 2 5\n", "v 0 0 0 -1 0 0\n", "vn nan 0 0\nf 1//1 2//1 3//1\n",
                                "f 1//9 2//9 3//9\n", "v 1 2 3 4 5\n", "mtllib nan.mtl\n"}) {
    write("scene.obj", kSquare + bad + "f 1 2 3\n");
    EXPECT_NO_THROW(load_scene(folder_ / "scene.obj")) << bad;
    EXPECT_THROW(load_scene(folder_ / "scene.obj", {.is_strict = true}), InputError) << bad;
  }
}

// Materials

TEST_F(ObjTest, FactorsAreTakenAsTheyStand) {
  const Material m = material("Ka 0.1 0.2 0.3\nKd 0.4 0.5 0.6\nKs 2 1 0\nNs 96\nKe 3 0 0\nillum 2\n");
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.phong().ambient, vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(m.phong().diffuse, vec3(0.4F, 0.5F, 0.6F));
  EXPECT_EQ(m.phong().specular, vec3(2, 1, 0));
  EXPECT_EQ(m.phong().shininess, 96);
  EXPECT_EQ(m.emissive, vec3(3, 0, 0));
  EXPECT_EQ(m.phong().reflection, vec3(0));
}

TEST_F(ObjTest, WhatAMaterialLeavesOutIsNotBlack) {
  const Material m = material("");
  EXPECT_EQ(m.phong().diffuse, vec3(0.8F));
  EXPECT_EQ(m.phong().ambient, vec3(0.8F));
  EXPECT_EQ(m.phong().specular, vec3(0));
  EXPECT_EQ(m.phong().shininess, 0);
  EXPECT_EQ(material("Kd 0 0 1\n").phong().ambient, vec3(0, 0, 1));
  EXPECT_EQ(material("Ka 0 0 0\nKd 0 0 1\n").phong().ambient, vec3(0));
}

TEST_F(ObjTest, IlluminationModels) {
  const std::string factors = "Ka 0.1 0.1 0.1\nKd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nNs 10\nillum ";
  const Material color = material(factors + "0\n");
  EXPECT_EQ(color.emissive, vec3(0.5F));
  EXPECT_EQ(color.phong().diffuse, vec3(0));
  EXPECT_EQ(color.phong().ambient, vec3(0));
  EXPECT_EQ(material(factors + "1\n").phong().specular, vec3(0));
  EXPECT_EQ(material(factors + "2\n").phong().specular, vec3(0.25F));
  EXPECT_EQ(material(factors + "2\n").phong().reflection, vec3(0));
  EXPECT_EQ(material(factors + "3\n").phong().specular, vec3(0.25F));
  EXPECT_EQ(material(factors + "3\n").phong().reflection, vec3(0.25F));
}

TEST_F(ObjTest, GlassIsRead) {
  const std::string factors = "Kd 0 0 0\nKs 0.25 0.25 0.25\nTf 0.5 0.75 1\nNi 1.25\nillum ";
  const Material bent = material(factors + "6\n");
  EXPECT_EQ(bent.phong().transmission, vec3(0.5F, 0.75F, 1.0F));
  EXPECT_EQ(bent.phong().ior, 1.25F);
  EXPECT_FALSE(bent.phong().fresnel);
  EXPECT_EQ(bent.phong().reflection, vec3(0.25F));
  const Material glass = material(factors + "7\n");
  EXPECT_EQ(glass.phong().transmission, vec3(0.5F, 0.75F, 1.0F));
  EXPECT_TRUE(glass.phong().fresnel);
  EXPECT_EQ(glass.alpha_mode, AlphaMode::kOpaque);
  const Material mirror = material(factors + "5\n");
  EXPECT_EQ(mirror.phong().transmission, vec3(0.0F));
  EXPECT_TRUE(mirror.phong().fresnel);
  EXPECT_EQ(mirror.phong().ior, 1.25F);
  // What is transparent in part lets as much through its filter.
  const Material half = material(factors + "4\nd 0.5\n");
  EXPECT_EQ(half.phong().transmission, vec3(0.25F, 0.375F, 0.5F));
  EXPECT_EQ(half.phong().ior, 1.0F);
  EXPECT_EQ(half.alpha_mode, AlphaMode::kOpaque);
  EXPECT_EQ(material("illum 4\nd 0.5\n").alpha_mode, AlphaMode::kBlend) << "without Tf d tells alone";
  EXPECT_EQ(material("illum 7\n").phong().transmission, vec3(1.0F));
  EXPECT_EQ(material("illum 7\n").phong().ior, 1.5F) << "glass where the file does not say";
  EXPECT_EQ(material("illum 2\nTf 0.5 0.5 0.5\n").phong().transmission, vec3(0.0F));
  const Material rough = material("illum 7\nd 0.25\nPr 0.5\n");
  EXPECT_EQ(rough.alpha, 0.25F) << "without Phong's glass d holds";
}

TEST_F(ObjTest, TransparencyAndOtherMapsAreSaid) {
  std::vector<std::string> warnings;
  material("illum 4\n", &warnings);
  EXPECT_THAT(warnings, ElementsAre("material \"m\" is of glass (illum 4) with a d of 1, it is drawn opaque"));
  material("illum 7\nNi -1\n", &warnings);
  EXPECT_THAT(warnings, ElementsAre("material \"m\": its Ni is no index of refraction, 1.5 is taken"));
  material("map_Ns wood.png\ndisp wood.png\n", &warnings);
  EXPECT_THAT(warnings,
              ElementsAre("material \"m\": some of its texture maps are ignored, the first is map_Ns in m.mtl line 2"));
  material("map_Bump -bm 2 wood.png\nbump wood.png\n", &warnings);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("bump maps, which hold heights, are ignored")));
}

TEST_F(ObjTest, AMissingMtlIsGrey) {
  const LoadedScene scene = load(kSquare + "mtllib none.mtl\nusemtl red\nf 1 2 3\n");
  EXPECT_EQ(scene.materials.at(scene.objects[0].material).phong().diffuse, vec3(0.8F));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("\"none.mtl\" does not exist"), HasSubstr("\"red\" is in no MTL")));
}

TEST_F(ObjTest, FacesKeepTheirMaterials) {
  write("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  const LoadedScene scene = load(kSquare +
                                 "mtllib two.mtl\nf 1 2 3\nusemtl blue\nf 1 2 3 4\nusemtl red\nf 1 2 3\n"
                                 "o one\nusemtl blue\nf 1 2 3\n");
  const Mesh& mesh = mesh_of(scene);
  ASSERT_THAT(mesh.triangle_materials, SizeIs(4));
  std::vector<vec3> colors;
  for (const uint32_t material : mesh.triangle_materials)
    colors.push_back(scene.materials.at(material).phong().diffuse);
  EXPECT_THAT(colors, ElementsAre(vec3(0.8F), vec3(0, 0, 1), vec3(0, 0, 1), vec3(1, 0, 0)));
  EXPECT_THAT(mesh_of(scene, 1).triangle_materials, IsEmpty());
  EXPECT_EQ(scene.materials.at(scene.objects[1].material).name, "blue");
}

TEST_F(ObjTest, AColourOfOneNumberIsGrey) {
  EXPECT_EQ(material("Kd 0.5\n").phong().diffuse, vec3(0.5F));
  EXPECT_EQ(material("Kd 0.5 # grey\n").phong().diffuse, vec3(0.5F));
  EXPECT_EQ(material("Kd 0.5 0.25\n").phong().diffuse, vec3(0.5F, 0.25F, 0.0F));
  EXPECT_EQ(material("Kd\n").phong().diffuse, vec3(0.8F));
}

TEST_F(ObjTest, StatementsBeforeTheFirstMaterialAreOfNone) {
  write("two.mtl", "Kd 1 0 0\nd 0.5\nnewmtl a\nKs 1\nKs 0 1 0\nKd 0 0 1\nnewmtl b\n");
  const LoadedScene scene = load(kSquare + "mtllib two.mtl\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
  ASSERT_THAT(scene.materials, SizeIs(2));
  EXPECT_EQ(scene.materials[0].phong().specular, vec3(0, 1, 0)) << "the last of equal statements holds";
  EXPECT_EQ(scene.materials[1].phong().diffuse, vec3(0.8F));
  EXPECT_EQ(scene.materials[1].phong().specular, vec3(0.0F));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(ObjTest, OpacityWinsOverTransparency) {
  std::vector<std::string> warnings;
  for (const char* opaque : {"d 1\n", "Tr 0\n", "d 1\nTr 1\n", "Tr 1\nd 1\n", "d full\n", "d 2\n"}) {
    EXPECT_EQ(material(opaque, &warnings).alpha_mode, AlphaMode::kOpaque) << opaque;
    EXPECT_THAT(warnings, IsEmpty()) << opaque;
  }
  for (const char* transparent : {"d 0.25\n", "Tr 0.75\n", "d 0.25\nTr 0\n", "d -halo 0.25\n", "illum 4\nd 0.25\n"}) {
    const Material blending = material(transparent, &warnings);
    EXPECT_EQ(blending.alpha_mode, AlphaMode::kBlend) << transparent;
    EXPECT_EQ(blending.alpha, 0.25F) << transparent;
    EXPECT_THAT(warnings, IsEmpty()) << transparent;
  }
}

TEST_F(ObjTest, MtlNamesMayHoldSpaces) {
  write("my colors.mtl", "newmtl deep red\r\nKd 1 0 0\r\n");
  const LoadedScene scene = load(kSquare + "mtllib my colors.mtl\nusemtl deep red\nf 1 2 3\n");
  EXPECT_EQ(scene.materials.at(0).phong().diffuse, vec3(1, 0, 0));
  write("a.mtl", "newmtl a\nKd 1 0 0\n");
  write("b.mtl", "newmtl b\nKd 0 1 0\n");
  EXPECT_EQ(load(kSquare + "mtllib a.mtl b.mtl\nusemtl b\nf 1 2 3\n").materials.at(0).phong().diffuse, vec3(0, 1, 0));
}

// Texture maps

/// Loads a square with texture coordinates on all corners and a material of these lines.
class ObjMapTest : public ObjTest {
 protected:
  ObjMapTest() { write_picture("a.png", {10, 20, 30}); }

  void write_picture(const std::string& name, const std::vector<uint8_t>& rgb, const uvec2& size = {1, 1}) const {
    const std::vector<std::byte> file = make_png(size, PNG_COLOR_TYPE_RGB, 8, rgb);
    write(name, {reinterpret_cast<const char*>(file.data()), file.size()});
  }
  LoadedScene load_with(const std::string& lines) const {
    write("m.mtl", "newmtl m\n" + lines);
    return load(kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0.25\nmtllib m.mtl\nusemtl m\nf 1/1 2/2 3/3 4/4\n");
  }
  static const TextureImage& image_of(const LoadedScene& scene, const TextureSlot& slot) {
    return *scene.images.at(scene.textures.at(slot.texture).image);
  }
};

TEST_F(ObjMapTest, MapsMultiplyTheirColours) {
  const LoadedScene scene = load_with("Kd 0.5 0.5 0.5\nKs 1 1 0\nNs 9\nmap_Kd a.png\nmap_Ks a.png\nmap_Ke a.png\n");
  EXPECT_THAT(scene.warnings, IsEmpty());
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.phong().diffuse, vec3(0.5F));
  EXPECT_EQ(material.phong().ambient, vec3(0.5F));
  EXPECT_EQ(material.phong().specular, vec3(1, 1, 0));
  EXPECT_EQ(material.emissive, vec3(1)) << "the map alone tells it";
  for (const TextureSlot& slot :
       {material.phong().diffuse_texture, material.phong().specular_texture, material.emissive_texture}) {
    ASSERT_TRUE(slot.exists());
    EXPECT_EQ(slot.to_u, vec3(1, 0, 0));
    EXPECT_EQ(slot.to_v, vec3(0, 1, 0));
    EXPECT_EQ(image_of(scene, slot).use, ImageUse::kColor);
    EXPECT_THAT(image_of(scene, slot).texels, ElementsAre(0xFF1E140AU));
  }
  EXPECT_FALSE(material.phong().normal_texture.exists());
  EXPECT_THAT(scene.images, SizeIs(1)) << "one picture of one use";
  EXPECT_THAT(scene.textures, SizeIs(1));
}

TEST_F(ObjMapTest, OnlyAMissingColourIsThatOfTheMap) {
  EXPECT_EQ(load_with("map_Kd a.png\n").materials.at(0).phong().diffuse, vec3(1));
  EXPECT_EQ(load_with("Kd 0 0 0\nmap_Kd a.png\n").materials.at(0).phong().diffuse, vec3(0));
}

TEST_F(ObjMapTest, NormalsAreTakenAsNormals) {
  const LoadedScene scene = load_with("norm a.png\n");
  const TextureSlot& slot = scene.materials.at(0).phong().normal_texture;
  ASSERT_TRUE(slot.exists());
  EXPECT_EQ(image_of(scene, slot).use, ImageUse::kNormal);
}

TEST_F(ObjMapTest, TextureCoordinatesGrowUpwards) {
  const LoadedScene scene = load_with("map_Kd a.png\n");
  EXPECT_THAT(mesh_of(scene).uvs,
              ElementsAre(vec4(0, 1, 0, 0), vec4(1, 1, 0, 0), vec4(1, 0, 0, 0), vec4(0.5F, 0.75F, 0, 0)));
}

TEST_F(ObjMapTest, WithoutMapsThereAreNoTextureCoordinates) {
  const LoadedScene scene = load_with("Kd 1 1 1\n");
  EXPECT_THAT(mesh_of(scene).uvs, IsEmpty());
  write("m.mtl", "newmtl m\nmap_Kd a.png\nnewmtl n\n");
  const LoadedScene two = load("vt nan 0\nvt 0 0\nmtllib m.mtl\n" + kSquare +
                               "usemtl n\nf 1/1 2/2 3/1\nf 1/2 2/1 3/2\no a\nusemtl m\nf 1/2 2/2 3/2\n");
  EXPECT_THAT(mesh_of(two, 0).positions, SizeIs(3)) << "coordinates that nothing shows split no vertices";
  EXPECT_THAT(mesh_of(two, 0).uvs, IsEmpty());
  EXPECT_THAT(mesh_of(two, 1).uvs, SizeIs(3));
}

TEST_F(ObjMapTest, CornersThatAreEqualAreShared) {
  write("m.mtl", "newmtl m\nmap_Kd a.png\n");
  const std::string head = "mtllib m.mtl\nusemtl m\nvt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 0 2\n" + kSquare;
  const auto vertices_of = [&](const std::string& faces) { return mesh_of(load(head + faces)).positions.size(); };
  EXPECT_EQ(vertices_of("f 1/1 2/1 3/1\nf 1/1 3/1 4/1\n"), 4U);
  EXPECT_EQ(vertices_of("f 1/1 2/1 3/1\nf 1/2 3/1 4/1\n"), 5U);
  EXPECT_EQ(vertices_of("f 1/1/1 2/1/1 3/1/1\nf 1/1/2 3/1/1 4/1/1\n"), 5U);
  EXPECT_EQ(vertices_of("f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/-2/-2\n"), 4U);
}

TEST_F(ObjMapTest, CoordinatesThatAreMissingAreSaid) {
  write("m.mtl", "newmtl m\nmap_Kd a.png\n");
  const LoadedScene scene = load("mtllib m.mtl\nusemtl m\nvt 0 x\n" + kSquare + "f 1/1 2/7 3\n");
  // They are 0; v goes down in meshes, where 1 is 0 as the texture repeats.
  EXPECT_THAT(mesh_of(scene).uvs, Each(vec4(0, 0, 0, 0)));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("no numbers up to 1e15"), HasSubstr("corners without texture")));
}

TEST_F(ObjMapTest, OptionsPlaceTheMap) {
  const LoadedScene scene =
      load_with("map_Kd -blendu off -s 2 4 1 -mm 0 1 -o 0.5 0.25 -clamp on -imfchan m a.png\nmap_Ks -s 3 a.png\n");
  EXPECT_THAT(scene.warnings, IsEmpty());
  const TextureSlot& slot = scene.materials.at(0).phong().diffuse_texture;
  EXPECT_EQ(slot.to_u, vec3(2, 0, 0.5F));
  // Upwards v' = 4 v + 0.25, so downwards 1 - v' = 4 (1 - v) - 3.25.
  EXPECT_EQ(slot.to_v, vec3(0, 4, -3.25F));
  EXPECT_EQ(scene.textures.at(slot.texture).wrap_u, TextureWrap::kClampToEdge);
  EXPECT_EQ(scene.textures.at(slot.texture).wrap_v, TextureWrap::kClampToEdge);
  const TextureSlot& specular = scene.materials.at(0).phong().specular_texture;
  EXPECT_EQ(specular.to_u, vec3(3, 0, 0));
  EXPECT_EQ(specular.to_v, vec3(0, 1, 0));
  EXPECT_EQ(scene.textures.at(specular.texture).wrap_u, TextureWrap::kRepeat);
}

TEST_F(ObjMapTest, FilesLieBesideTheirMtl) {
  std::filesystem::create_directories(folder_ / "parts" / "pictures");
  write_picture("parts/pictures/deep red 1.png", {200, 0, 0});
  write_picture("parts/7", {1, 2, 3});
  write("parts/m.mtl", "newmtl m\r\nmap_Kd -s 1 1 1 pictures\\deep red 1.png\r\nmap_Ke -o 1 2 7\r\n");
  const LoadedScene scene = load(kSquare + "vt 0 0\nmtllib parts/m.mtl\nusemtl m\nf 1/1 2/1 3/1\n");
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(image_of(scene, scene.materials.at(0).phong().diffuse_texture).name, "parts/pictures/deep red 1.png");
  EXPECT_EQ(image_of(scene, scene.materials.at(0).emissive_texture).name, "parts/7");
}

TEST_F(ObjMapTest, PathsOfOtherMachinesLeadToTheFileBeside) {
  for (const std::string name :
       {"C:\\textures\\a.png", "/home/x/a.png", "../a.png", "a.png # colour", "x/a.png # colour"}) {
    const LoadedScene scene = load_with("map_Kd " + name + "\n");
    EXPECT_THAT(scene.warnings, IsEmpty()) << name;
    EXPECT_TRUE(scene.materials.at(0).phong().diffuse_texture.exists()) << name;
  }
  EXPECT_THAT(load_with("map_Kd # none\n").warnings, IsEmpty());
}

TEST_F(ObjMapTest, WhatCannotBeReadIsSaidAndLeftOut) {
  write("broken.png", "no picture");
  write("empty.png", "");
  const LoadedScene scene = load_with("map_Kd none.png\nmap_Ke broken.png\nmap_Ks ../b.png\nnorm empty.png\n");
  EXPECT_THAT(scene.warnings,
              testing::UnorderedElementsAre(
                  testing::StartsWith("a file does not exist (\"none.png\"); materials are drawn without it"),
                  testing::StartsWith("a picture cannot be used: it is of no known format, image \"broken.png\""),
                  testing::StartsWith("a file's name leaves the scene's folder (\"../b.png\"); materials"),
                  testing::StartsWith("the file is empty, image \"empty.png\"")));
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.phong().diffuse, vec3(0.8F));
  EXPECT_EQ(material.phong().specular, vec3(0));
  EXPECT_EQ(material.emissive, vec3(0));
  EXPECT_FALSE(material.phong().diffuse_texture.exists());
  EXPECT_FALSE(material.emissive_texture.exists());
  EXPECT_THAT(scene.images, IsEmpty());
  std::vector<SourceFile> sources;
  load_scene(folder_ / "scene.obj", {}, sources);
  EXPECT_THAT(sources, Contains(testing::Field(&SourceFile::file, folder_ / "none.png"))) << "it may come later";
}

TEST_F(ObjMapTest, TheMapOfAmbientLightIsThatOfKd) {
  EXPECT_THAT(load_with("map_Ka a.png\nmap_Kd a.png\n").warnings, IsEmpty());
  EXPECT_THAT(load_with("map_Ka b.png\nmap_Kd a.png\n").warnings, ElementsAre(HasSubstr("its map_Ka is ignored")));
}

TEST_F(ObjMapTest, IllumZeroIsUnlit) {
  const LoadedScene scene = load_with("Kd 1 0.5 0\nillum 0\nmap_Kd a.png\n");
  const auto& unlit = std::get<Unlit>(scene.materials.at(0).model);
  EXPECT_EQ(unlit.color, vec3(1, 0.5F, 0));
  EXPECT_TRUE(unlit.color_texture.exists());
}

TEST_F(ObjMapTest, PhysicalFactorsMakeAPhysicalMaterial) {
  const auto model_of = [&](const std::string& lines) {
    return std::get<MetallicRoughness>(load_with(lines).materials.at(0).model);
  };
  const MetallicRoughness both = model_of("Kd 0.5 2 0\nPr 0.25\nPm 0.75\nKe 1 0 0\n");
  EXPECT_EQ(both.base_color, vec3(0.5F, 1, 0));
  EXPECT_EQ(both.roughness, 0.25F);
  EXPECT_EQ(both.metallic, 0.75F);
  EXPECT_FALSE(both.metallic_roughness_texture.exists());
  EXPECT_EQ(model_of("Pm 1\n").roughness, 1.0F);
  EXPECT_EQ(model_of("Pr 0\n").metallic, 0.0F);
  EXPECT_EQ(model_of("Pr 0\n").base_color, vec3(0.8F));
  const MetallicRoughness mapped = model_of("Pr 1\nmap_Kd a.png\nnorm -bm 0.5 a.png\n");
  EXPECT_EQ(mapped.base_color, vec3(1));
  EXPECT_TRUE(mapped.base_color_texture.exists());
  EXPECT_TRUE(mapped.normal_texture.exists());
  EXPECT_EQ(mapped.normal_scale, 0.5F);
}

TEST_F(ObjMapTest, RoughnessAndMetallicShareAPicture) {
  write_picture("m.png", {100, 0, 0});
  const LoadedScene scene = load_with("Pr 0.5\nPm 0.5\nmap_Pr -s 2 2 a.png\nmap_Pm m.png\n");
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("options of map_Pm")));
  const auto& model = std::get<MetallicRoughness>(scene.materials.at(0).model);
  EXPECT_EQ(model.roughness, 1.0F) << "the map tells it alone";
  EXPECT_EQ(model.metallic, 1.0F);
  EXPECT_EQ(model.metallic_roughness_texture.to_u, vec3(2, 0, 0));
  EXPECT_EQ(image_of(scene, model.metallic_roughness_texture).use, ImageUse::kData);
  EXPECT_THAT(image_of(scene, model.metallic_roughness_texture).texels, ElementsAre(0xFF640AFFU));
  EXPECT_THAT(scene.images, SizeIs(1));
}

TEST_F(ObjMapTest, OneMapOfTheTwoIsEnough) {
  const LoadedScene rough = load_with("Pm 0.5\nmap_Pr a.png\nmap_Pm none.png\n");
  const auto& model = std::get<MetallicRoughness>(rough.materials.at(0).model);
  EXPECT_EQ(model.roughness, 1.0F);
  EXPECT_EQ(model.metallic, 0.5F);
  EXPECT_THAT(image_of(rough, model.metallic_roughness_texture).texels, ElementsAre(0xFFFF0AFFU));
  const LoadedScene none = load_with("Pr 0.5\nmap_Pr none.png\n");
  EXPECT_EQ(std::get<MetallicRoughness>(none.materials.at(0).model).roughness, 0.5F);
  EXPECT_FALSE(std::get<MetallicRoughness>(none.materials.at(0).model).metallic_roughness_texture.exists());
}

TEST_F(ObjMapTest, OpacityHasAMap) {
  write_picture("c.png", {1, 2, 3});
  write_picture("o.png", {50, 0, 0, 60, 0, 0}, {2, 1});
  const LoadedScene both = load_with("map_Kd c.png\nmap_d o.png\nd 0.5\n");
  EXPECT_THAT(both.warnings, IsEmpty());
  const Material& material = both.materials.at(0);
  EXPECT_EQ(material.alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(material.alpha, 0.5F);
  const TextureImage& image = image_of(both, material.phong().diffuse_texture);
  EXPECT_EQ(image.size, uvec2(2, 1));
  EXPECT_EQ(image.use, ImageUse::kColor);
  EXPECT_THAT(image.texels, ElementsAre(0x32030201U, 0x3C030201U));
  const LoadedScene alone = load_with("map_d o.png\n");
  EXPECT_THAT(image_of(alone, alone.materials.at(0).phong().diffuse_texture).texels,
              ElementsAre(0x32FFFFFFU, 0x3CFFFFFFU));
  const LoadedScene same = load_with("map_Kd c.png\nmap_d c.png\n");
  EXPECT_THAT(image_of(same, same.materials.at(0).phong().diffuse_texture).texels, ElementsAre(0xFF030201U));
  EXPECT_EQ(same.materials.at(0).alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(load_with("map_Kd c.png\n").materials.at(0).alpha_mode, AlphaMode::kOpaque);
}

TEST_F(ObjMapTest, TheSmallerPictureIsEnlarged) {
  write_picture("r.png", {1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0}, {4, 1});
  write_picture("m.png", {5, 0, 0, 6, 0, 0}, {2, 1});
  const LoadedScene scene = load_with("map_Pr r.png\nmap_Pm m.png\n");
  EXPECT_THAT(scene.warnings,
              ElementsAre("images \"r.png\" and \"m.png\" differ in size, the smaller one is enlarged"));
  const auto& model = std::get<MetallicRoughness>(scene.materials.at(0).model);
  EXPECT_THAT(image_of(scene, model.metallic_roughness_texture).texels,
              ElementsAre(0xFF0501FFU, 0xFF0502FFU, 0xFF0603FFU, 0xFF0604FFU));
}

// Refusals

/// The texts follow the square.
class BadObjTest : public BadFileTest {};

TEST_P(BadObjTest, IsRefusedWithPlaceAndCure) {
  expect_refusal("bad.obj", kSquare + GetParam().text + "\nf 1 2 3\n");
}

const BadFile kBadObj[] = {
    {"IndexZero", "f 0 1 2", "\"0\" is no corner", ": line 5"},
    {"IndexPastTheEnd", "f 1 2 5", "index 5 is out of range, there are 4 vertices", ": line 5"},
    {"RelativePastTheStart", "f -1 -2 -5", "\"-5\" is no corner", ": line 5"},
    {"IndexOverflows", "f 1 2 99999999999", "\"99999999999\" is no corner", ": line 5"},
    {"IndexOverflowsMore", "f 1 2 99999999999999999999", "is no corner", ": line 5"},
    {"IndexIsText", "f a b c", "\"a\" is no corner", ": line 5"},
    {"TooManySlashes", "f 1/2/3/4 2 3", "\"1/2/3/4\" is no corner", ": line 5"},
    {"NoPosition", "f /1 2 3", "is no corner", ": line 5"},
};

INSTANTIATE_TEST_SUITE_P(Table, BadObjTest, testing::ValuesIn(kBadObj), name_of_bad_file);

TEST_F(ObjTest, BrokenFilesSayWhy) {
  EXPECT_THAT(SceneFolder::refusal(folder_ / "none.obj"), HasSubstr("not found"));
  EXPECT_THAT(SceneFolder::refusal(folder_), HasSubstr("unknown scene format"));
  EXPECT_THAT(refusal(""), HasSubstr("empty"));
  EXPECT_THAT(refusal(std::string_view("v 0\0 0 0", 9)), HasSubstr("not text"));
  EXPECT_THAT(refusal("f 1 2 3\nf a b c\nf 0 1 1\n"), HasSubstr("(1 of 3 problems)"));
}

// Polygons

double area_of(const std::vector<vec3>& corners, const std::vector<uvec3>& triangles) {
  double area = 0.0;
  for (const uvec3& t : triangles) {
    const dvec3 a(corners[t.x]);
    area += 0.5 * glm::cross(dvec3(corners[t.y]) - a, dvec3(corners[t.z]) - a).z;
  }
  return area;
}

TEST(TriangulateTest, ConcavePolygonsAreCoveredOnce) {
  // A thin arrow head: its shorter diagonal lies outside.
  const std::vector<vec3> arrow = {{0, 10, 0}, {-0.5F, 0, 0}, {0, 8, 0}, {0.5F, 0, 0}};
  // A comb with two teeth, and a C.
  const std::vector<vec3> comb = {{0, 0, 0}, {5, 0, 0}, {5, 4, 0}, {4, 4, 0},
                                  {4, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}};
  for (const auto& [corners, area] : {std::pair{arrow, 1.0}, std::pair{comb, 11.0}}) {
    for (size_t start = 0; start < corners.size(); ++start) {
      std::vector<vec3> rotated = corners;
      std::rotate(rotated.begin(), rotated.begin() + static_cast<std::ptrdiff_t>(start), rotated.end());
      const std::vector<uvec3> triangles = triangulate_polygon(rotated);
      ASSERT_EQ(triangles.size(), corners.size() - 2);
      EXPECT_NEAR(area_of(rotated, triangles), area, 1e-6);
      for (const uvec3& t : triangles) EXPECT_GE(area_of(rotated, {t}), 0.0) << "a triangle lies outside";
    }
  }
}

TEST(TriangulateTest, EveryPlaneAndWindingWorks) {
  for (const int axis : {0, 1, 2}) {
    std::vector<vec3> corners;
    for (const auto& [u, v] : {std::pair{0, 10}, {-1, 0}, {0, 8}, {1, 0}}) {
      vec3 corner(3.0F);
      corner[(axis + 1) % 3] = static_cast<float>(u);
      corner[(axis + 2) % 3] = static_cast<float>(v);
      corners.push_back(corner);
    }
    for (int winding = 0; winding < 2; ++winding) {
      dvec3 area(0.0);
      double size = 0.0;
      for (const uvec3& t : triangulate_polygon(corners)) {
        const dvec3 a(corners[t.x]);
        const dvec3 cross = 0.5 * glm::cross(dvec3(corners[t.y]) - a, dvec3(corners[t.z]) - a);
        area += cross;
        size += glm::length(cross);
      }
      EXPECT_NEAR(area[axis], winding == 0 ? 2.0 : -2.0, 1e-9);
      EXPECT_NEAR(size, 2.0, 1e-9);
      std::reverse(corners.begin(), corners.end());
    }
  }
}

TEST(TriangulateTest, EveryPolygonGivesTwoTrianglesLessThanCorners) {
  const std::vector<vec3> collinear = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {1.5F, 1.5F, 1.5F}};
  const std::vector<vec3> same(6, vec3(1));
  const std::vector<vec3> crossing = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}, {-1, 1, 0}};
  for (const auto& corners : {collinear, same, crossing}) {
    EXPECT_EQ(triangulate_polygon(corners).size(), corners.size() - 2);
  }
}

TEST_F(ObjTest, TriangleTooSmallToHitIsSaid) {
  const auto triangle = [](const std::string& size) {
    return "v 0 0 0\nv " + size + " 0 0\nv 0 " + size + " 0\nf 1 2 3\n";
  };
  EXPECT_THAT(load(triangle("1e-17")).warnings, Not(Contains(HasSubstr("1e-18"))));
  EXPECT_THAT(load(triangle("1e-20")).warnings, Contains(HasSubstr("object 0 is smaller than 1e-18")));
}

}  // namespace
}  // namespace promin
