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

using testing::AllOf;
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

  /// Checks that a strict loader refuses a text that the usual loader reads, with this problem at this place.
  void expect_strict_refusal(std::string_view text, const char* what, const std::string& where) const {
    const std::filesystem::path file = write("strict.obj", text);
    EXPECT_EQ(SceneFolder::refusal(file), "");
    const std::string said = message_of([&] { load_scene(file, {.is_strict = true}); });
    EXPECT_THAT(said, HasProblem(what));
    EXPECT_THAT(said, HasSubstr("strict.obj" + where));
  }

  /// Returns the material "m" of an MTL with these lines.
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

// The next tests check faces.

TEST_F(ObjTest, FacesCountFromTheFrontOrTheBack) {
  const std::vector<vec3> wanted = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  EXPECT_EQ(corners_of(mesh_of(load(kSquare + "f 1 2 3"))), wanted);
  EXPECT_EQ(corners_of(mesh_of(load(kSquare + "f -4 -3 -2\n"))), wanted);
  EXPECT_EQ(corners_of(mesh_of(load("f 1 2 3\n" + kSquare))), wanted) << "vertices may follow";
  EXPECT_EQ(corners_of(mesh_of(load(kSquare + "f 1/7 2/8 3/9 # no texture shows these\n"))), wanted);
}

TEST_F(ObjTest, LineEndsOfEveryKindWork) {
  EXPECT_THAT(mesh_of(load("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n")).triangles, SizeIs(1));
  EXPECT_THAT(mesh_of(load("v 0 0 0\rv 1 0 0\r\rv 0 1 0\rf 1 2 3\r")).triangles, SizeIs(1));
  EXPECT_THAT(mesh_of(load("# one\rv 0 0 0\nv 1 0 0\r\nv 0 1 0\rf 1 2 \\\r3")).triangles, SizeIs(1)) << "mixed";
  EXPECT_THAT(refusal("v 0 0 0\r\nv 1 0 0\rv 0 1 0\nf 1 2 9\r\n"), HasSubstr(": line 4"));
  EXPECT_THAT(mesh_of(load("\tv  0\t0 0 \nv +1 0 0\nv 0 1e0 0#c\n\n  f 1 2 3")).triangles, SizeIs(1));
}

TEST_F(ObjTest, LinesOfAnMtlMayEndInCrAlone) {
  EXPECT_EQ(material("Kd 1 0 0\rKs 0 1 0\r").phong().diffuse, vec3(1, 0, 0));
  write("cr.mtl", "# of an old Mac\rnewmtl a b\rKd 0 0 1\r");
  const LoadedScene scene = load(kSquare + "mtllib cr.mtl\rusemtl a b\rf 1 2 3");
  EXPECT_EQ(scene.materials.at(0).phong().diffuse, vec3(0, 0, 1));
}

// Windows editors write a byte order mark. If it were not skipped, the first line would not be a statement.
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

// The text is Latin-1, as older programs write it. Messages that quote it are still valid UTF-8, even if a quoted word
// is shortened.
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
    EXPECT_THAT(said, HasSubstr("is not a corner"));
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
  EXPECT_THAT(mixed.warnings, ElementsAre(HasSubstr("length 0")));
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
  EXPECT_THAT(refusal(kSquare), HasProblem("obj.faces.none 4"));
  EXPECT_THAT(refusal("# nothing\n"), HasProblem("obj.faces.none"));
  EXPECT_THAT(refusal(kSquare + "l 1 2\np 3\n"), HasProblem("obj.faces.none lines points"));
  EXPECT_THAT(refusal(kSquare + "f 1 2\nf 3 4\n"), HasProblem("obj.faces.none"));
}

// The next tests check faults that affect only colours, shading or data that no face uses.

TEST_F(ObjTest, FacesOfFewerThanThreeCornersAreLeftOut) {
  const LoadedScene scene = load(kSquare + "f 1 2\nf 1 2 3\nf\no b\nf 4//1\nf 1 2 3 4\n");
  EXPECT_THAT(mesh_of(scene, 0).triangles, SizeIs(1));
  EXPECT_THAT(mesh_of(scene, 1).triangles, SizeIs(2)) << "those left out have no number";
  EXPECT_THAT(scene.warnings, ElementsAre("line 5: a face has fewer than 3 corners, and 2 more; promin omits it"));
  expect_strict_refusal(kSquare + "f 1 2\nf 1 2 3\n", "obj.face.corners", ": line 5");
}

TEST_F(ObjTest, VerticesThatNoFaceUsesMayHoldAnything) {
  const std::string text = "v nan 0 0\n" + kSquare + "v 1 2\nv 0,5 0 0\nv 1e30 0 0\nv\nf 2 3 4\n";
  const LoadedScene scene = load(text);
  EXPECT_EQ(corners_of(mesh_of(scene)), (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("no face uses"), HasSubstr("\"nan\" is not a number"),
                                                HasSubstr("line 1: "), HasSubstr(", and 4 more; "))));
  expect_strict_refusal(text, "obj.position.range", ": line 1");
}

TEST_F(ObjTest, FacesOfVerticesWithoutAPlaceAreLeftOut) {
  const std::string text = "o a\nf 1 2 3\no b\nf 5 1 2\nf 1 3 4\nf 6 5 1\no c\nf 7 8 1\n" + kSquare +
                           "v 0 -inf 0\nv 0,5 1 2\nv 1 2\nv 1e999 0 0\n";
  const LoadedScene scene = load(text);
  ASSERT_THAT(scene.objects, SizeIs(2)) << "an object without a face is none";
  EXPECT_THAT(mesh_of(scene, 1).triangles, SizeIs(1));
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("a face has a vertex that is not three numbers up to 1e15"),
                                                HasSubstr("\"-inf\" is not a number"), HasSubstr("line 13: "),
                                                HasSubstr(", and 2 more; "), HasSubstr("promin omits the face"))));
  expect_strict_refusal(text, "obj.position.range", ": line 13");
  EXPECT_THAT(refusal("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), HasProblem("obj.faces.none"));
}

TEST_F(ObjTest, NumbersBehindAVertexCostAWarning) {
  const LoadedScene rgba = load("v 0 0 0 1 0.5 0 1\nv 1 0 0 1 0 0 0.5 9\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(mesh_of(rgba).colors, ElementsAre(vec4(1, 0.5F, 0, 1), vec4(1, 0, 0, 1), vec4(1)));
  EXPECT_THAT(rgba.warnings, ElementsAre(HasSubstr("line 1: a vertex has more than 6 numbers, and 1 more")));
  const LoadedScene colors = load("v 0 0 0 nan 0 0\nv 1 0 0 0 -1 0\nv 0 1 0 0.5 0 0\nf 1 2 3\n");
  EXPECT_THAT(mesh_of(colors).colors, ElementsAre(vec4(1), vec4(1), vec4(0.5F, 0, 0, 1)));
  EXPECT_THAT(colors.warnings,
              ElementsAre(AllOf(HasSubstr("colour is not three"), HasSubstr("line 1: "), HasSubstr(", and 1 more; "))));
  const LoadedScene others = load("v 0 0 0 1 2\nv 1 0 0 x\nv 0 1 0 0 0 0\nf 1 2 3\n");
  EXPECT_EQ(mesh_of(others).positions.at(1), vec3(1, 0, 0));
  EXPECT_THAT(others.warnings, ElementsAre(AllOf(HasSubstr("neither a weight nor a colour"), HasSubstr("and 1 more"))));
  expect_strict_refusal("v 0 0 0 1 1 1 1\n" + kSquare + "f 1 2 3\n", "obj.vertex.numbers", ": line 1");
  expect_strict_refusal("v 0 0 0 1 x 1\n" + kSquare + "f 1 2 3\n", "obj.color.range", ": line 1");
}

TEST_F(ObjTest, NormalsThatAreNoNumbersMakeTheirFacesSharp) {
  const std::string text = kSquare + "vn nan nan nan\nvn 1 0 0\nvn 0 1\nvn 1 0 0 5\nvn 1e30 0 0\n" +
                           "f 1//2 2//2 3//4\nf 1//2 3//1 4//2\nf 1//3 2//2 4//2\n";
  const LoadedScene scene = load(text);
  const Mesh& mesh = mesh_of(scene);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_EQ(mesh.normals.at(mesh.triangles[0].z), vec3(1, 0, 0));
  for (const size_t sharp : {1, 2}) EXPECT_EQ(mesh.normals.at(mesh.triangles[sharp].x), vec3(0, 0, 1));
  EXPECT_THAT(scene.warnings, ElementsAre("line 5: a normal is not three numbers up to 1e15 (\"nan\"), and 2 more; the "
                                          "faces that use it are shaded flat",
                                          HasSubstr("line 8: a normal has more than 3 numbers")));
  expect_strict_refusal(text, "obj.normal.range", ": line 5");
}

TEST_F(ObjTest, NormalsThatAreNotThereMakeTheirFacesSharp) {
  const LoadedScene none = load(kSquare + "f 1//1 2//2 3//3\nf 1//1 3//3 4//4\n");
  EXPECT_THAT(mesh_of(none).normals, IsEmpty());
  EXPECT_THAT(none.warnings,
              ElementsAre("line 5: a face refers to a normal that does not exist, and 1 more; it is shaded flat"));
  const LoadedScene some = load(kSquare +
                                "vn 1 0 0\nf 1//1 2//1 3//2\nf 1//1 3//-2 4//0\nf 1//1 3//x 4//1\n"
                                "f 1//1 2//1 3//1\nf 1//1 2//1 3//99999999999999999999\n");
  const Mesh& mesh = mesh_of(some);
  for (const size_t sharp : {0, 1, 2, 4}) EXPECT_EQ(mesh.normals.at(mesh.triangles[sharp].x), vec3(0, 0, 1));
  EXPECT_EQ(mesh.normals.at(mesh.triangles[3].x), vec3(1, 0, 0));
  EXPECT_THAT(some.warnings, ElementsAre(AllOf(HasSubstr("line 6: "), HasSubstr(", and 3 more; "))));
  EXPECT_THAT(load(kSquare + "f 1//1 2//1 3//1\nvn 1 0 0\n").warnings, IsEmpty()) << "normals may follow";
  expect_strict_refusal(kSquare + "f 1//1 2//1 3//1\n", "obj.normal.index", ": line 5");
}

TEST_F(ObjTest, TextureCoordinatesThatAreNotThereCostAWarning) {
  const LoadedScene scene = load(kSquare + "vt 0 0\nf 1/1 2/2 3/x\nf 1/-9 2/1 3/0\nf 1/1 2/1 3/1\n");
  EXPECT_THAT(mesh_of(scene).triangles, SizeIs(3));
  EXPECT_THAT(
      scene.warnings,
      ElementsAre(
          "line 6: a face refers to texture coordinates that do not exist, and 1 more; it is drawn without them"));
  expect_strict_refusal(kSquare + "f 1/1 2/1 3/1\n", "obj.uv.index", ": line 5");
  expect_strict_refusal(kSquare + "vt nan 0\nf 1 2 3\n", "obj.uv.range", ": line 5");
}

TEST_F(ObjTest, ZeroBytesAtTheEndAreCutOff) {
  const std::string padded = kSquare + "f 1 2 3" + std::string(5, '\0');
  EXPECT_THAT(mesh_of(load(padded)).triangles, SizeIs(1));
  EXPECT_THAT(load(padded).warnings, IsEmpty());
  EXPECT_THAT(refusal(kSquare + std::string("f 1 2 3\0\n", 9)), HasProblem("obj.file.kind"));
  EXPECT_THAT(refusal(std::string(9, '\0')), HasProblem("obj.faces.none"));
  write("m.mtl", "newmtl m\nKd 1 0 0" + std::string(3, '\0'));
  const LoadedScene scene = load(kSquare + "mtllib m.mtl\nusemtl m\nf 1 2 3\n");
  EXPECT_EQ(scene.materials.at(0).phong().diffuse, vec3(1, 0, 0));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

// The next tests check materials.

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
  // A partly transparent material also transmits only a fraction through its filter.
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
  EXPECT_THAT(warnings, ElementsAre("material \"m\" is glass (illum 4) and has a d of 1; promin draws it opaque"));
  material("illum 7\nNi -1\n", &warnings);
  EXPECT_THAT(warnings, ElementsAre("material \"m\": its Ni is not an index of refraction; promin uses 1.5"));
  material("map_Ns wood.png\ndisp wood.png\n", &warnings);
  EXPECT_THAT(warnings,
              ElementsAre("material \"m\": some of its texture maps are ignored, the first is map_Ns in m.mtl line 2"));
}

TEST_F(ObjTest, NumbersOfMaterialsThatAreNoneAreIgnored) {
  std::vector<std::string> warnings;
  const Material m = material("Kd 1 0 0\nKs nan nan nan\nNs nan\nKa 0,5 0,5 0,5\nKs 0,5 0,5 0,5\n", &warnings);
  EXPECT_EQ(m.phong().diffuse, vec3(1, 0, 0));
  EXPECT_EQ(m.phong().ambient, vec3(1, 0, 0));
  EXPECT_EQ(m.phong().specular, vec3(0));
  EXPECT_THAT(warnings,
              ElementsAre("mtllib m.mtl line 3: Ks of a material is not a number from 0 to 1e15 (\"nan\"), and 1 "
                          "more; promin ignores the statement",
                          HasSubstr("Ns of a material"), HasSubstr("Ka of a material")));
  for (const char* line : {"Kd x\n", "Ke 1e999 0 0\n", "illum -1\n", "Ns 1e16\n", "d full\n", "Tr x\n", "Ni nan\n"}) {
    EXPECT_EQ(material(std::string("Kd 1 0 0\nd 0.5\n") + line, &warnings).phong().diffuse, vec3(1, 0, 0)) << line;
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("promin ignores the statement"))) << line;
    expect_strict_refusal(kSquare + "mtllib m.mtl\nusemtl m\nf 1 2 3\n", "mtl.number.range", ": mtllib m.mtl line 4");
  }
  EXPECT_EQ(material("Kd -0.5 0.25 -1e-9\n", &warnings).phong().diffuse, vec3(0, 0.25F, 0));
  EXPECT_THAT(warnings, ElementsAre("mtllib m.mtl line 2: Kd of a material is negative; 0 is used"));
  expect_strict_refusal(kSquare + "mtllib m.mtl\nusemtl m\nf 1 2 3\n", "mtl.number.range", ": mtllib m.mtl line 2");
  EXPECT_EQ(material("Ns 10 of 1000\n", &warnings).phong().shininess, 10) << "one number is read of one";
  EXPECT_THAT(warnings, IsEmpty());
}

// Both statements are valid MTL, so a strict loader accepts them.
TEST_F(ObjTest, ColoursOfOtherSpacesAreIgnored) {
  std::vector<std::string> warnings;
  const Material m = material("Kd 1 0 0\nKa spectral file.rfl 1\nKs xyz 0.1 0.2 0.3\n", &warnings);
  EXPECT_EQ(m.phong().ambient, vec3(1, 0, 0));
  EXPECT_EQ(m.phong().specular, vec3(0));
  EXPECT_THAT(warnings, ElementsAre("colours given as spectral are ignored, the first is Ka in mtllib m.mtl line 3",
                                    "colours given as xyz are ignored, the first is Ks in mtllib m.mtl line 4"));
  EXPECT_NO_THROW(load_scene(folder_ / "scene.obj", {.is_strict = true}));
}

// 3ds Max and other programs write Tr 1 for opaque materials.
TEST_F(ObjTest, WhatWouldBeInvisibleByTrIsOpaque) {
  std::vector<std::string> warnings;
  EXPECT_EQ(material("Kd 1 0 0\nTr 1.000000\nillum 1\n", &warnings).alpha_mode, AlphaMode::kOpaque);
  EXPECT_THAT(warnings,
              ElementsAre(AllOf(HasSubstr("\"m\" would be invisible because of its Tr"), HasSubstr("of m.mtl"))));
  write("tr.mtl", "newmtl a\nTr 1\nnewmtl b\nTr 0.25\nnewmtl c\nd 0.5\nTr 0.5\nnewmtl d\nTr 0\n");
  const LoadedScene scene = load(kSquare +
                                 "mtllib tr.mtl\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n"
                                 "usemtl c\nf 1 2 3\nusemtl d\nf 1 2 3\n");
  std::vector<float> alphas;
  for (const Material& each : scene.materials) alphas.push_back(each.alpha);
  EXPECT_THAT(alphas, ElementsAre(1, 0.25F, 0.5F, 1)) << "a file is of one convention";
  EXPECT_THAT(scene.warnings, SizeIs(1));
  const Material glass = material("Tr 1\nillum 7\n", &warnings);
  EXPECT_EQ(glass.phong().transmission, vec3(1)) << "glass is not invisible";
  EXPECT_THAT(warnings, IsEmpty());
}

TEST_F(ObjTest, WhatIsInvisibleByDIsSaid) {
  std::vector<std::string> warnings;
  EXPECT_EQ(material("d 0\n", &warnings).alpha, 0.0F);
  EXPECT_THAT(warnings, ElementsAre("material \"m\" is invisible because its d is 0"));
  material("d 0\nTf 1 1 1\nillum 4\n", &warnings);
  EXPECT_THAT(warnings, IsEmpty()) << "glass";
}

// The next tests check names.

TEST_F(ObjTest, CommentsMayFollowNames) {
  write("a.mtl",
        "newmtl red # bright\nKd 1 0 0 # colour\nmap_Kd # none\nnewmtl c#\nKd 0 1 0\nnewmtl d # e\nKd 0 0 1\n");
  const LoadedScene scene = load(kSquare +
                                 "mtllib a.mtl # the library\nusemtl red # the red one\nf 1 2 3 # a face\n"
                                 "usemtl c#\nf 1 2 3\nusemtl d # e\nf 1 2 3\nusemtl d\t# f\nf 1 2 3\n");
  std::vector<vec3> colors;
  for (const Material& material : scene.materials) colors.push_back(material.phong().diffuse);
  EXPECT_THAT(colors, ElementsAre(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0, 0, 1)));
  EXPECT_EQ(scene.materials.at(2).name, "d # e") << "the whole name goes first";
  EXPECT_THAT(scene.warnings, IsEmpty());
  write("my lib.mtl", "newmtl red\nKd 1 0 0\n");
  EXPECT_THAT(load(kSquare + "mtllib my lib.mtl # mine\nusemtl red\nf 1 2 3\n").warnings, IsEmpty());
}

TEST_F(ObjTest, AnMtlOfAnotherFolderIsReadFromBesideTheScene) {
  write("a.mtl", "newmtl red\nKd 1 0 0\n");
  for (const char* name : {"C:\\Users\\some one\\a.mtl", "/home/someone/a.mtl", "../up/a.mtl", "D:a.mtl", "lib/a.mtl",
                           "file:///x/a.mtl", "\\\\server\\share\\a.mtl # x"}) {
    const LoadedScene scene = load(kSquare + "mtllib " + name + "\nusemtl red\nf 1 2 3\n");
    EXPECT_EQ(scene.materials.at(0).phong().diffuse, vec3(1, 0, 0)) << name;
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("from the scene's folder"))) << name;
  }
  write("b.mtl", "newmtl blue\nKd 0 0 1\n");
  const LoadedScene two = load(kSquare + "mtllib /x/a.mtl /x/b.mtl\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n");
  EXPECT_EQ(two.materials.at(0).phong().diffuse, vec3(1, 0, 0));
  EXPECT_EQ(two.materials.at(1).phong().diffuse, vec3(0, 0, 1));
  EXPECT_THAT(two.warnings, SizeIs(1));
}

TEST_F(ObjTest, NoMtlRefusesAMesh) {
  const auto warnings_of = [&](const std::string& line) {
    const LoadedScene scene = load(kSquare + line + "\nf 1 2 3\n");
    EXPECT_THAT(mesh_of(scene).triangles, SizeIs(1)) << line;
    return scene.warnings;
  };
  EXPECT_THAT(warnings_of("mtllib ../none.mtl"),
              ElementsAre(HasSubstr("leads out of the scene's folder (\"../none.mtl\")")));
  EXPECT_THAT(warnings_of("mtllib /etc/none"), ElementsAre(HasSubstr("is absolute (\"/etc/none\")")));
  EXPECT_THAT(warnings_of("mtllib C:\\none.mtl"), ElementsAre(HasSubstr("is not relative")));
  EXPECT_THAT(warnings_of("mtllib"), IsEmpty());
  write("empty.mtl", "");
  EXPECT_THAT(warnings_of("mtllib empty.mtl"), ElementsAre(HasSubstr("\"empty.mtl\" is ignored: the file is empty")));
  std::filesystem::create_directories(folder_ / "folder.mtl");
  EXPECT_THAT(warnings_of("mtllib folder.mtl"),
              ElementsAre(HasSubstr("the path of a file is a folder (\"folder.mtl\")")));
}

TEST_F(ObjTest, AMissingMtlIsGrey) {
  const LoadedScene scene = load(kSquare + "mtllib none.mtl\nusemtl red\nf 1 2 3\n");
  EXPECT_EQ(scene.materials.at(scene.objects[0].material).phong().diffuse, vec3(0.8F));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("\"none.mtl\", so its materials are grey"),
                                          HasSubstr("\"red\" is not defined in any MTL")));
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
  for (const char* opaque : {"d 1\n", "Tr 0\n", "d 1\nTr 1\n", "Tr 1\nd 1\n", "d 2\n"}) {
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

// The next tests check texture maps.

/// Loads a square with texture coordinates at all corners, and a material with these lines.
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
  // The file's coordinates are 0. In meshes v goes down, where it would be 1; that is 0, because the texture repeats.
  EXPECT_THAT(mesh_of(scene).uvs, Each(vec4(0, 0, 0, 0)));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("not a number up to 1e15"), HasSubstr("that do not exist"),
                                          HasSubstr("have no texture coordinates")));
}

TEST_F(ObjMapTest, OptionsPlaceTheMap) {
  const LoadedScene scene =
      load_with("map_Kd -blendu off -s 2 4 1 -mm 0 1 -o 0.5 0.25 -clamp on -imfchan m a.png\nmap_Ks -s 3 a.png\n");
  EXPECT_THAT(scene.warnings, IsEmpty());
  const TextureSlot& slot = scene.materials.at(0).phong().diffuse_texture;
  EXPECT_EQ(slot.to_u, vec3(2, 0, 0.5F));
  // Upwards v' = 4 v + 0.25; therefore downwards 1 - v' = 4 (1 - v) - 3.25.
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

TEST_F(ObjMapTest, WhatCannotBeReadIsSaidAndLeftOut) {
  write("broken.png", "no picture");
  write("empty.png", "");
  const LoadedScene scene = load_with("map_Kd none.png\nmap_Ke broken.png\nmap_Ks ../b.png\nnorm empty.png\n");
  EXPECT_THAT(
      scene.warnings,
      testing::UnorderedElementsAre(
          testing::StartsWith("a referenced file does not exist (\"none.png\"); promin draws materials without it"),
          testing::StartsWith("image \"broken.png\": a picture cannot be used: its format is unknown"),
          testing::StartsWith("the path of a file leads out of the scene's folder (\"../b.png\"); promin"),
          testing::StartsWith("image \"empty.png\": the file is empty")));
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

TEST_F(ObjMapTest, PicturesOfOtherFoldersAreReadFromBesideTheScene) {
  std::filesystem::create_directories(folder_ / "parts");
  write_picture("parts/b.png", {200, 0, 0});
  for (const char* name : {"C:\\textures\\b.png", "/home/x/b.png", "../b.png", "-s 2 2 2 D:\\my files\\b.png",
                           "t/b.png", "b.png # red", "/x/b.png # red"}) {
    write("parts/m.mtl", std::string("newmtl m\nmap_Kd ") + name + "\n");
    const LoadedScene scene = load(kSquare + "vt 0 0\nmtllib parts/m.mtl\nusemtl m\nf 1/1 2/1 3/1\n");
    const TextureSlot& slot = scene.materials.at(0).phong().diffuse_texture;
    ASSERT_TRUE(slot.exists()) << name;
    EXPECT_EQ(image_of(scene, slot).name, "parts/b.png") << name;
  }
  const LoadedScene beside = load_with("map_Kd C:\\x\\a.png\nmap_Ks /y/a.png\n");
  EXPECT_TRUE(beside.materials.at(0).phong().specular_texture.exists());
  EXPECT_THAT(beside.warnings, ElementsAre(HasSubstr("from the scene's folder")));
  EXPECT_THAT(load_with("map_Kd C:\\x\\none.png\n").warnings, ElementsAre(HasSubstr("is not relative")));
}

// The next tests check height maps.

/// Returns the normal of a texel, without the rounding error of its 8 bits.
vec3 normal_at(const TextureImage& image, uint32_t x, uint32_t y) {
  const uint32_t texel = image.texels.at(uint64_t{y} * image.size.x + x);
  return 2.0F / 255.0F * vec3(texel & 0xFF, texel >> 8 & 0xFF, texel >> 16 & 0xFF) - 1.0F;
}

/// Returns the slopes along u and v of a normal.
vec2 slope_at(const TextureImage& image, uint32_t x, uint32_t y) {
  const vec3 normal = normal_at(image, x, y);
  return -vec2(normal) / normal.z;
}

/// The step between neighbouring 8-bit values of a normal's component.
constexpr float kStep = 2.0F / 255.0F;

class ObjHeightsTest : public ObjMapTest {
 protected:
  /// Writes a ramp of 16 columns from black to 240, the same in all 4 rows; or one of 16 rows, which grows downwards.
  void write_ramp(bool is_of_rows) const {
    std::vector<uint8_t> grey;
    const uvec2 size = is_of_rows ? uvec2(4, 16) : uvec2(16, 4);
    for (uint32_t y = 0; y < size.y; ++y) {
      for (uint32_t x = 0; x < size.x; ++x) grey.push_back(static_cast<uint8_t>(16 * (is_of_rows ? y : x)));
    }
    write_png("ramp.png", make_png(size, PNG_COLOR_TYPE_GRAY, 8, grey));
  }
  void write_png(const std::string& name, const std::vector<std::byte>& file) const {
    write(name, {reinterpret_cast<const char*>(file.data()), file.size()});
  }
  TextureImage normals_of(const std::string& lines, std::vector<std::string>* warnings = nullptr) const {
    const LoadedScene scene = load_with(lines);
    if (warnings != nullptr) *warnings = scene.warnings;
    const TextureSlot& slot = scene.materials.at(0).phong().normal_texture;
    if (!slot.exists()) return {};
    EXPECT_EQ(image_of(scene, slot).use, ImageUse::kNormal);
    return image_of(scene, slot);
  }
};

TEST_F(ObjHeightsTest, ARampHasOneSlope) {
  write_ramp(false);
  for (const char* keyword : {"bump", "map_bump", "map_Bump"}) {
    std::vector<std::string> warnings;
    const TextureImage normals = normals_of(std::string(keyword) + " -bm 8 ramp.png\n", &warnings);
    EXPECT_THAT(warnings, IsEmpty()) << keyword;
    ASSERT_EQ(normals.size, uvec2(16, 4)) << keyword;
    for (uint32_t x = 1; x < 15; ++x) {
      EXPECT_NEAR(slope_at(normals, x, 2).x, 8.0F * 16.0F / 255.0F, 2.0F * kStep) << x;
      EXPECT_NEAR(slope_at(normals, x, 2).y, 0.0F, 2.0F * kStep);
    }
    // The picture repeats, so 16 lies beside 240.
    for (const uint32_t x : {0U, 15U}) EXPECT_NEAR(slope_at(normals, x, 0).x, -8.0F * 112.0F / 255.0F, 0.2F);
  }
  EXPECT_NEAR(slope_at(normals_of("bump -bm -8 ramp.png\n"), 5, 0).x, -8.0F * 16.0F / 255.0F, 2.0F * kStep);
  EXPECT_NEAR(slope_at(normals_of("bump -bm 2 -mm 0.25 4 ramp.png\n"), 5, 0).x, 8.0F * 16.0F / 255.0F, 2.0F * kStep);
  EXPECT_NEAR(slope_at(normals_of("bump ramp.png\n"), 5, 0).x, 16.0F / 255.0F, kStep) << "-bm is 1";
  EXPECT_NEAR(slope_at(normals_of("bump -bm 8 -s -2 1 ramp.png\n"), 5, 0).x, -8.0F * 16.0F / 255.0F, 2.0F * kStep)
      << "mirrored";
}

TEST_F(ObjHeightsTest, HeightsThatGrowDownwardsFallAlongV) {
  write_ramp(true);
  const TextureImage normals = normals_of("bump -bm 8 ramp.png\n");
  for (uint32_t y = 1; y < 15; ++y) EXPECT_NEAR(slope_at(normals, 1, y).y, -8.0F * 16.0F / 255.0F, 2.0F * kStep);
}

TEST_F(ObjHeightsTest, ClampedEdgesGoOnLevel) {
  write_ramp(false);
  const TextureImage normals = normals_of("bump -clamp on -bm 8 ramp.png\n");
  for (const uint32_t x : {0U, 15U}) EXPECT_NEAR(slope_at(normals, x, 0).x, 8.0F * 8.0F / 255.0F, 2.0F * kStep) << x;
}

TEST_F(ObjHeightsTest, WhatHasNoSlopesCostsNothing) {
  EXPECT_TRUE(normals_of("bump a.png\n").texels.empty()) << "one pixel";
  write_picture("flat.png", std::vector<uint8_t>(12, 77), {2, 2});
  EXPECT_TRUE(normals_of("bump flat.png\n").texels.empty());
  write_ramp(false);
  EXPECT_TRUE(normals_of("bump -bm 0 ramp.png\n").texels.empty());
  EXPECT_THAT(load_with("bump flat.png\n").images, IsEmpty());
  std::vector<std::string> warnings;
  EXPECT_TRUE(normals_of("bump none.png\n", &warnings).texels.empty());
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("a referenced file does not exist (\"none.png\")")));
}

TEST_F(ObjHeightsTest, PicturesOfSixteenBitsWork) {
  std::vector<uint8_t> rows;
  for (int x = 0; x < 8; ++x) rows.insert(rows.end(), {static_cast<uint8_t>(16 * x), 0});
  write_png("deep.png", make_png({8, 1}, PNG_COLOR_TYPE_GRAY, 16, rows));
  const TextureImage normals = normals_of("bump -bm 8 deep.png\n");
  EXPECT_NEAR(slope_at(normals, 3, 0).x, 8.0F * 16.0F / 255.0F, 2.0F * kStep);
  EXPECT_NEAR(slope_at(normals, 3, 0).y, 0.0F, 2.0F * kStep) << "one row is its own neighbour";
}

TEST_F(ObjHeightsTest, AChannelMayBeChosen) {
  std::vector<uint8_t> rgb;
  for (uint8_t x = 0; x < 8; ++x) {
    const auto red = static_cast<uint8_t>(16 * x);
    const auto green = static_cast<uint8_t>(255 - 8 * x);
    rgb.insert(rgb.end(), {red, green, 60});
  }
  write_picture("rgb.png", rgb, {8, 1});
  EXPECT_NEAR(slope_at(normals_of("bump -imfchan r -bm 4 rgb.png\n"), 3, 0).x, 64.0F / 255.0F, 2.0F * kStep);
  EXPECT_NEAR(slope_at(normals_of("bump -imfchan g -bm 4 rgb.png\n"), 3, 0).x, -32.0F / 255.0F, 2.0F * kStep);
  EXPECT_NEAR(slope_at(normals_of("bump -bm 16 rgb.png\n"), 3, 0).x,
              16.0F * (0.2126F * 16.0F - 0.7152F * 8.0F) / 255.0F, 2.0F * kStep);
  EXPECT_NEAR(slope_at(normals_of("bump -imfchan b -bm 4 rgb.png\n"), 3, 0).x, 0.0F, kStep);
}

TEST_F(ObjHeightsTest, APictureOfNormalsIsTakenForOne) {
  write_picture("n.png", {128, 128, 255, 160, 128, 250, 128, 90, 248, 100, 128, 251}, {4, 1});
  std::vector<std::string> warnings;
  const TextureImage normals = normals_of("map_Bump -bm 0.5 n.png\n", &warnings);
  EXPECT_EQ(normals.texels.at(1), 0xFFFA80A0U);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("\"n.png\" of a height map contains normals")));
  // Bright grey texels are also vectors of length 1, and photographs may be blue.
  write_picture("grey.png", {200, 200, 200, 201, 201, 201, 199, 199, 199, 202, 202, 202}, {4, 1});
  normals_of("bump grey.png\n", &warnings);
  EXPECT_THAT(warnings, IsEmpty());
  write_picture("sea.png", {20, 60, 130, 10, 90, 200, 40, 80, 180, 0, 10, 90}, {4, 1});
  normals_of("bump sea.png\n", &warnings);
  EXPECT_THAT(warnings, IsEmpty());
}

TEST_F(ObjHeightsTest, NormWinsAndBothModelsHaveHeights) {
  write_ramp(false);
  EXPECT_EQ(normals_of("bump ramp.png\nnorm a.png\n").size, uvec2(1));
  const LoadedScene physical = load_with("Pr 0.5\nbump -bm 8 ramp.png\n");
  const auto& model = std::get<MetallicRoughness>(physical.materials.at(0).model);
  ASSERT_TRUE(model.normal_texture.exists());
  EXPECT_EQ(model.normal_scale, 1.0F);
  EXPECT_NEAR(slope_at(image_of(physical, model.normal_texture), 5, 0).x, 8.0F * 16.0F / 255.0F, 2.0F * kStep);
  EXPECT_THAT(load_with("illum 0\nbump ramp.png\n").warnings, ElementsAre(HasSubstr("its bump is ignored")));
}

TEST_F(ObjMapTest, OptionsThatAreNotReadAreSaid) {
  EXPECT_THAT(load_with("map_Kd -t 0.1 0.1 0 a.png\n").warnings, ElementsAre("the option -t of map_Kd is ignored"));
  EXPECT_THAT(load_with("map_Kd -t 0 0 0 -mm 0 1 a.png\n").warnings, IsEmpty());
  EXPECT_THAT(load_with("map_Kd -mm 0.5 2 a.png\n").warnings, ElementsAre("the option -mm of map_Kd is ignored"));
  EXPECT_THAT(load_with("map_d -imfchan b a.png\n").warnings, ElementsAre("the option -imfchan of map_d is ignored"));
  EXPECT_THAT(load_with("map_d -imfchan l a.png\n").warnings, IsEmpty());
  EXPECT_THAT(load_with("bump -imfchan z a.png\n").warnings, ElementsAre("the option -imfchan of bump is ignored"));
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
              ElementsAre("images \"r.png\" and \"m.png\" differ in size; promin enlarges the smaller one"));
  const auto& model = std::get<MetallicRoughness>(scene.materials.at(0).model);
  EXPECT_THAT(image_of(scene, model.metallic_roughness_texture).texels,
              ElementsAre(0xFF0501FFU, 0xFF0502FFU, 0xFF0603FFU, 0xFF0604FFU));
}

// The next tests check refusals.

/// Each text follows the square's text.
class BadObjTest : public BadFileTest {};

TEST_P(BadObjTest, IsRefusedWithPlaceAndCure) {
  expect_refusal("bad.obj", kSquare + GetParam().text + "\nf 1 2 3\n");
}

const BadFile kBadObj[] = {
    {"IndexZero", "f 0 1 2", "obj.face.corner \"0\"", ": line 5"},
    {"IndexPastTheEnd", "f 1 2 5", "obj.face.index 5 4", ": line 5"},
    {"RelativePastTheStart", "f -1 -2 -5", "obj.face.corner \"-5\"", ": line 5"},
    {"IndexOverflows", "f 1 2 99999999999", "obj.face.corner \"99999999999\"", ": line 5"},
    {"IndexOverflowsMore", "f 1 2 99999999999999999999", "obj.face.corner", ": line 5"},
    {"IndexIsText", "f a b c", "obj.face.corner \"a\"", ": line 5"},
    {"TooManySlashes", "f 1/2/3/4 2 3", "obj.face.corner \"1/2/3/4\"", ": line 5"},
    {"NoPosition", "f /1 2 3", "obj.face.corner", ": line 5"},
    {"NoFaceOfThreeCorners", "f 1 2\nf 1 x 2", "obj.face.corner \"x\"", ": line 6"},
};

INSTANTIATE_TEST_SUITE_P(Table, BadObjTest, testing::ValuesIn(kBadObj), name_of_bad_file);

TEST_F(ObjTest, BrokenFilesSayWhy) {
  EXPECT_THAT(SceneFolder::refusal(folder_ / "none.obj"), HasProblem("file.missing"));
  EXPECT_THAT(SceneFolder::refusal(folder_), HasProblem("file.folder"));
  EXPECT_THAT(refusal(""), HasProblem("file.empty"));
  EXPECT_THAT(refusal(std::string_view("v 0 0\0 0", 8)), HasProblem("obj.file.kind"));
  EXPECT_THAT(refusal("f 1 2 3\nf a b c\nf 0 1 1\n"),
              testing::ResultOf([](const std::string& list) { return std::ranges::count(list, '\n'); }, 4));
}

// The next tests check polygons.

double area_of(const std::vector<vec3>& corners, const std::vector<uvec3>& triangles) {
  double area = 0.0;
  for (const uvec3& t : triangles) {
    const dvec3 a(corners[t.x]);
    area += 0.5 * glm::cross(dvec3(corners[t.y]) - a, dvec3(corners[t.z]) - a).z;
  }
  return area;
}

TEST(TriangulateTest, ConcavePolygonsAreCoveredOnce) {
  // A thin arrow head, whose shorter diagonal lies outside.
  const std::vector<vec3> arrow = {{0, 10, 0}, {-0.5F, 0, 0}, {0, 8, 0}, {0.5F, 0, 0}};
  // A comb with two teeth, and a polygon in the shape of a C.
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
