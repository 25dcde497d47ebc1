// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "promin/lighting.h"
#include "promin/validate.h"
#include "support/bad_file.h"
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

const std::string kView = "v\nfrom 1 2 8\nat 1 2 3\nup 0 2 1\nangle 45\nhither 0.5\nresolution 640 480\n";
const std::string kMaterial = "f 0.5 0.25 1 0.5 0.25 20 0 0\n";
const std::string kSquarePolygon = "p 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

class NffTest : public SceneFolder {
 protected:
  Scene load(const std::string& file) {
    write("scene.nff", file);
    return load_scene(folder_ / "scene.nff");
  }
  std::string refusal(const std::string& file) const { return SceneFolder::refusal("scene.nff", file); }
};

template <class Shape>
const Shape& shape_of(const Scene& scene, size_t object) {
  return std::get<Shape>(scene.geometries.at(scene.objects.at(object).geometry));
}

TEST_F(NffTest, ViewsAreCameras) {
  const Scene scene = load("b 0.25 0.5 0.75\n" + kView + kMaterial + "s 0 0 0 1\n");
  ASSERT_THAT(scene.cameras, SizeIs(1));
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.projection, Projection::kPerspective);
  EXPECT_EQ(camera.eye, vec3(1, 2, 8));
  EXPECT_EQ(camera.look, vec3(0, 0, -1));
  EXPECT_EQ(camera.up, vec3(0, 1, 0));
  EXPECT_FLOAT_EQ(camera.yfov, glm::radians(45.0F)) << "the whole angle";
  EXPECT_EQ(camera.near, 0.5F);
  EXPECT_EQ(camera.resolution, uvec2(640, 480));
  EXPECT_FLOAT_EQ(camera.aspect_ratio, 4.0F / 3.0F);
  EXPECT_EQ(scene.environment.background, vec3(0.25F, 0.5F, 0.75F));
  EXPECT_EQ(scene.environment.ambient, vec3(0.0F));
  EXPECT_TRUE(scene.is_classic);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(NffTest, TheBackgroundMayFollowTheView) {
  EXPECT_EQ(load(kView + "b 1 0 0\n" + kMaterial + "s 0 0 0 1\n").environment.background, vec3(1, 0, 0));
}

TEST_F(NffTest, NormalsAgainstTheWindingAreWarnedOf) {
  const std::string turned = "pp 3\n0 0 0 0 0 -1\n1 0 0 0 0 -1\n0 1 0 0 0 -1\n";
  const std::string right = "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n";
  EXPECT_THAT(load(kMaterial + right).warnings, Each(Not(HasSubstr("against"))));
  EXPECT_THAT(
      load(kMaterial + turned + right + turned).warnings,
      Contains("2 triangles have vertex normals that point against their winding; promin reverses the normals"));
}

TEST_F(NffTest, LinesMeanNothing) {
  std::string text = "b 0.25 0.5 0.75 # sky\n" + kView + kMaterial + kSquarePolygon + "l 1 2 3\ns 0 0 0 1\n#the end";
  const Scene scene = load(text);
  std::replace(text.begin(), text.end(), '\n', '\t');
  text.replace(text.find("# sky"), 5, "#f 1 2\n");
  const Scene same = load(text);
  EXPECT_THAT(same.objects, SizeIs(2));
  EXPECT_EQ(same.cameras[0].resolution, scene.cameras[0].resolution);
  EXPECT_EQ(same.lights[0].position, scene.lights[0].position);
  EXPECT_THAT(load(with_carriage_returns("s 0 0 0\n\n1\n")).objects, SizeIs(1));
  EXPECT_THAT(load("# comments end with a line\rs 0 0 0\r1\r#too").objects, SizeIs(1));
  EXPECT_THAT(load("s 0 0 0 1" + std::string(3, '\0')).objects, SizeIs(1));
}

TEST_F(NffTest, LightsShareWhatTheyHave) {
  const Scene scene = load("l 1 2 3\nl 4 5 6 0.5 0.25 0\nl 7 8 9\nl 0 0 0\ns 0 0 0 1\n");
  ASSERT_THAT(scene.lights, SizeIs(4));
  EXPECT_EQ(scene.lights[0].position, vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[0].diffuse, vec3(0.25F)) << "sqrt(4) / (2 * 4)";
  EXPECT_EQ(scene.lights[0].specular, vec3(0.25F));
  EXPECT_EQ(scene.lights[1].diffuse, vec3(0.5F, 0.25F, 0));
  EXPECT_EQ(scene.lights[1].specular, vec3(0.5F, 0.25F, 0));
  for (const Light& light : scene.lights) {
    EXPECT_EQ(light.kind, LightKind::kPoint);
    EXPECT_EQ(light.attenuation, Attenuation::kNone);
  }
}

TEST_F(NffTest, WithoutLightsThereIsAHeadlight) {
  Scene dark = load(kMaterial + "s 0 0 0 1\n");
  EXPECT_THAT(dark.lights, IsEmpty());
  const AssumedLight assumed = light_scene(dark);
  EXPECT_TRUE(assumed.has_headlight && assumed.has_ambient);
  EXPECT_FALSE(assumed.has_studio || assumed.has_background);
  Scene lit = load("l 1 2 3\n" + kMaterial + "s 0 0 0 1\n");
  light_scene(lit);
  EXPECT_THAT(lit.lights, SizeIs(1));
  EXPECT_EQ(lit.environment.ambient, vec3(0.0F));
  EXPECT_FALSE(lit.environment.has_sky());
  EXPECT_EQ(display_of(lit), DisplayTransform());
}

TEST_F(NffTest, MaterialsAreOfPhong) {
  const Scene scene = load(kMaterial + "s 0 0 0 1\n");
  ASSERT_THAT(scene.materials, SizeIs(1));
  const Phong& phong = scene.materials[0].phong();
  EXPECT_EQ(phong.diffuse, vec3(0.25F, 0.125F, 0.5F)) << "Kd times the colour";
  EXPECT_EQ(phong.specular, vec3(0.25F)) << "highlights are white";
  EXPECT_EQ(phong.reflection, vec3(0.25F));
  EXPECT_EQ(phong.shininess, 20.0F);
  EXPECT_EQ(phong.transmission, vec3(0.0F));
  EXPECT_EQ(phong.ior, 1.0F) << "0 stands for none";
  const Scene glass = load("f 1 1 1 0 0.25 20 0.75 1.5 s 0 0 0 1");
  EXPECT_EQ(glass.materials[0].phong().transmission, vec3(0.75F));
  EXPECT_EQ(glass.materials[0].phong().ior, 1.5F);
  EXPECT_FALSE(glass.materials[0].phong().fresnel) << "the weights are as they stand";
}

TEST_F(NffTest, PolygonsOfAMaterialAreOneMesh) {
  const Scene scene = load(kMaterial + kMaterial + "s 0 0 0 1\n" + kSquarePolygon + "s 1 0 0 1\n" + kSquarePolygon +
                           "l 1 2 3\nc 0 0 0 1 0 1 0 1\n" + kMaterial + kSquarePolygon + kMaterial);
  ASSERT_THAT(scene.objects, SizeIs(5));
  EXPECT_EQ(shape_of<Sphere>(scene, 0).center, dvec3(0.0));
  EXPECT_THAT(shape_of<Mesh>(scene, 1).triangles, SizeIs(4)) << "both polygons, in file order";
  EXPECT_EQ(shape_of<Sphere>(scene, 2).center, dvec3(1, 0, 0));
  EXPECT_TRUE(shape_of<Cylinder>(scene, 3).is_open);
  EXPECT_THAT(shape_of<Mesh>(scene, 4).triangles, SizeIs(2));
  EXPECT_THAT(scene.materials, SizeIs(2)) << "those of shapes";
}

TEST_F(NffTest, CylindersAndConesAreOpen) {
  const Scene scene = load("f 1 1 1 1 0 0 0 0 c 1 2 3 0.5 1 2 7 0.5 c 0 0 0 2 0 0 4 0 c 0 0 0 0 0 4 0 3");
  ASSERT_THAT(scene.objects, SizeIs(3));
  const auto& cylinder = shape_of<Cylinder>(scene, 0);
  EXPECT_EQ(cylinder.center, dvec3(1, 2, 5));
  EXPECT_EQ(cylinder.axis, dvec3(0, 0, 4));
  EXPECT_EQ(cylinder.half_height, 2.0);
  EXPECT_EQ(cylinder.radius, 0.5);
  EXPECT_TRUE(cylinder.is_open);
  const auto& cone = shape_of<Cone>(scene, 1);
  EXPECT_EQ(cone.center, dvec3(0, 0, 2));
  EXPECT_EQ(cone.half_height, 2.0);
  EXPECT_EQ(cone.radius_bottom, 2.0);
  EXPECT_EQ(cone.radius_top, 0.0);
  EXPECT_TRUE(cone.is_open);
  EXPECT_EQ(shape_of<Cone>(scene, 2).radius_top, 3.0);
}

TEST_F(NffTest, NegativeRadiiAreThoseOfShapesSeenFromInside) {
  const Scene scene = load("s 0 0 0 -2 c 0 0 0 -1 0 4 0 -1 c 0 0 0 -1 0 4 0 0");
  EXPECT_EQ(shape_of<Sphere>(scene, 0).radius, 2.0);
  EXPECT_EQ(shape_of<Cylinder>(scene, 1).radius, 1.0);
  EXPECT_EQ(shape_of<Cone>(scene, 2).radius_bottom, 1.0);
}

double mesh_area(const Mesh& mesh) {
  double area = 0.0;
  for (const uvec3& t : mesh.triangles) {
    const dvec3 a(mesh.positions[t.x]);
    area += 0.5 * glm::length(glm::cross(dvec3(mesh.positions[t.y]) - a, dvec3(mesh.positions[t.z]) - a));
  }
  return area;
}

TEST_F(NffTest, PolygonsMayBeConcave) {
  // The polygon is an arrow's head; a fan around its first corner would lie partly outside.
  const Scene scene = load("p 4 2 0 1 0 1 1 1 0 1 0 -1 1");
  const auto& mesh = shape_of<Mesh>(scene, 0);
  EXPECT_THAT(mesh.triangles, SizeIs(2));
  EXPECT_NEAR(mesh_area(mesh), 1.0, 1e-12);
  EXPECT_THAT(mesh.normals, IsEmpty());
  // The polygon is a comb of 40 teeth, with many notches.
  std::string comb = "p 81\n";
  for (int i = 0; i < 81; ++i) {
    comb += std::to_string(i) + (i == 0 || i == 80 ? " 0 0\n" : i % 2 == 1 ? " 2 0\n" : " 1 0\n");
  }
  // The outline goes from 0,0 to 80,0, and the base is its last side.
  const Scene teeth = load(comb);
  EXPECT_THAT(shape_of<Mesh>(teeth, 0).triangles, SizeIs(79));
  EXPECT_NEAR(mesh_area(shape_of<Mesh>(teeth, 0)), 119.0, 1e-9);
}

TEST_F(NffTest, DegeneratePolygonsKeepTheirTriangles) {
  for (const char* text : {"p 5 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0", "p 5 0 0 0 1 0 0 2 0 0 3 0 0 1 0 0",
                           "p 4 0 0 0 1 1 0 1 0 0 0 1 0", "p 5 0 0 0 1 0 0 1 0 0 1 1 0 0 1 0"}) {
    const Scene scene = load(text);
    const auto& mesh = shape_of<Mesh>(scene, 0);
    EXPECT_THAT(mesh.triangles, SizeIs(text[2] == '5' ? 3 : 2)) << text;
    EXPECT_THAT(validate(scene), IsEmpty()) << text;
  }
}

TEST_F(NffTest, PatchesHaveNormals) {
  const std::string patch = "pp 3 0 0 0 0 0 2 1 0 0 0 1 1 0 1 0 1 0 1\n";
  const Scene scene = load(kMaterial + patch);
  const auto& mesh = shape_of<Mesh>(scene, 0);
  EXPECT_THAT(mesh.positions, ElementsAre(vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)));
  EXPECT_THAT(mesh.normals, ElementsAre(vec3(0, 0, 2), vec3(0, 1, 1), vec3(1, 0, 1)));

  // The patch stands between flat polygons.
  const Scene mixed = load(kMaterial + kSquarePolygon + patch + kSquarePolygon);
  const auto& both = shape_of<Mesh>(mixed, 0);
  ASSERT_THAT(both.normals, SizeIs(both.positions.size()));
  EXPECT_EQ(both.normals[0], vec3(0, 0, 1));
  EXPECT_EQ(both.normals[6], vec3(0, 0, 2));
  EXPECT_EQ(both.normals.back(), vec3(0, 0, 1));
  EXPECT_THAT(validate(mixed), IsEmpty());

  const Scene flat = load(kMaterial + "pp 3 0 0 0 0 0 0 1 0 0 0 1 1 0 1 0 1 0 1\n");
  EXPECT_THAT(shape_of<Mesh>(flat, 0).normals, IsEmpty());
  EXPECT_THAT(flat.warnings, Contains(HasSubstr("a normal that is 0 or not a number")));
  const Scene unknown = load(kMaterial + "pp 3 0 0 0 nan inf 0 1 0 0 0 1 1 0 1 0 1 0 1\n");
  EXPECT_THAT(shape_of<Mesh>(unknown, 0).normals, IsEmpty());
  EXPECT_THAT(unknown.warnings, Contains(HasSubstr("the polygon is shaded flat")));
}

TEST_F(NffTest, ShapesBeforeAnyMaterialAreGrey) {
  const Scene scene = load("s 0 0 0 1\n" + kMaterial + "s 0 0 0 2\n");
  ASSERT_THAT(scene.objects, SizeIs(2));
  EXPECT_EQ(scene.materials[0].phong().diffuse, vec3(0.8F));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("before the first f")));
}

TEST_F(NffTest, AFileWithoutShapesShowsNothing) {
  for (const char* text : {"\n", "# nothing", "b 1 1 1\nf 1 1 1 1 1 1 1 1\n"}) {
    EXPECT_THAT(load(text).warnings, Contains("the scene contains nothing to draw"));
  }
}

// The next tests check faults that cost only a warning.

/// A fault in a file, and the warning that it causes.
struct NffRepair {
  const char* name;
  const char* text;
  const char* warning;
};

class NffRepairTest : public NffTest, public testing::WithParamInterface<NffRepair> {};

TEST_P(NffRepairTest, CostsAWarning) {
  const Scene scene = load(GetParam().text + std::string("\ns 0 0 0 1\n"));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr(GetParam().warning)));
  ASSERT_FALSE(scene.objects.empty());
  EXPECT_EQ(shape_of<Sphere>(scene, scene.objects.size() - 1).radius, 1.0);
  EXPECT_EQ(scene.objects.size(), 1U);
  EXPECT_THAT(validate(scene), IsEmpty());
  EXPECT_THROW(load_scene(folder_ / "scene.nff", {.is_strict = true}), InputError);
}

const NffRepair kNffRepairs[] = {
    {"NegativeColor", "f 1 -1 1 1 1 1 0 0",
     "line 1: \"f\" has a number that is not from 0 to 1e7 (\"-1\"); the nearest"},
    {"NegativeKd", "f 1 1 1 -0.5 1 1 0 0", "\"f\" has a number that is not from 0 to 1e7 (\"-0.5\")"},
    {"NanInMaterial", "f nan 1 1 1 1 1 0 0", "\"f\" has a number that is not from 0 to 1e7 (\"nan\")"},
    {"WordInMaterial", "f 0,5 1 1 1 1 1 0 0", "\"f\" has a number that is not from 0 to 1e7 (\"0,5\")"},
    {"ShortMaterial", "f 1 1 1 1 1 1 0",
     "line 1: \"f\" has too few numbers; the missing ones are set to the smallest value allowed"},
    {"LongMaterial", "f 1 1 1 1 1 1 0 0 1 2", "line 1: \"f\" has too many numbers (\"1\"), and 1 more"},
    {"NegativeBackground", "b 0 0 -1", "\"b\" has a number that is not from 0 to 1e7"},
    {"LongBackground", "b 0 0 1 1", "\"b\" has too many numbers"},
    {"NegativeLight", "l 0 0 0 1 1 -1", "\"l\" has a number that is not from 0 to 1e7"},
    {"LightOfTwo", "l 0 0 0 1 1", "\"l\" has too few numbers"},
    {"LightNowhere", "l 0 nan 0 1 1 1",
     "line 1: \"l\" has a coordinate that is not a number up to 1e15 (\"nan\"); promin omits"},
    {"ShortLight", "l 0 0", "\"l\" has a coordinate"},
    {"ViewWithoutUp", "v from 0 0 1 at 0 0 0 angle 45", "\"v\" lacks from, at, up or angle"},
    {"ViewNowhere", "v from 1 1 1 at 1 1 1 up 0 1 0 angle 45", "equal points from and at"},
    {"ViewOfNan", "v from 1 nan 1 at 1 1 1 up 0 1 0 angle 45", "\"v\" has a coordinate"},
    {"ViewOfTwo", "v from 1 1 at 1 1 1 up 0 1 0 angle 45", "\"v\" has a coordinate"},
    {"UpAlongView", "v from 0 0 1 at 0 0 0 up 0 0 2 angle 45", "up that is 0 or parallel"},
    {"NoUp", "v from 0 0 1 at 0 0 0 up 0 0 0 angle 45", "up that is 0 or parallel"},
    {"AngleZero", "v from 0 0 1 at 0 0 0 up 0 1 0 angle 0", "an angle that is not from 0.001 to 179.9"},
    {"AngleFlat", "v from 0 0 1 at 0 0 0 up 0 1 0 angle 180", "an angle that is not"},
    {"AngleNan", "v from 0 0 1 at 0 0 0 up 0 1 0 angle nan", "an angle that is not"},
    {"NegativeHither", "v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 hither -1", "not from 0 to 1e15 (\"-1\")"},
    {"NoPixels", "v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 resolution 0 512", "a resolution that is not two whole"},
    {"TooManyPixels", "v resolution 99999 512", "a resolution that is not two whole"},
    {"HalfAPixel", "v resolution 5.5 512", "a resolution that is not two whole"},
    {"SphereNan", "s nan 0 0 1",
     "line 1: \"s\" has a coordinate that is not a number up to 1e15 (\"nan\"); promin omits"},
    {"SphereInfinite", "s 0 0 inf 1", "\"s\" has a coordinate"},
    {"SphereBeyondDouble", "s 1e999 0 0 1", "\"s\" has a coordinate"},
    {"SphereTooFar", "s 1e16 0 0 1", "\"s\" has a coordinate"},
    {"RadiusNan", "s 0 0 0 nan", "\"s\" has a coordinate"},
    {"RadiusZero", "s 0 0 0 0", "\"s\" has a radius that is 0 or too small"},
    {"RadiusTooSmall", "s 0 0 0 1e-30", "\"s\" has a radius"},
    {"Radii", "c 0 0 0 0 1 0 0 0", "\"c\" has two radii of 0"},
    {"Signs", "c 0 0 0 1 1 0 0 -1", "\"c\" has one radius that is negative"},
    {"NoHeight", "c 1 2 3 1\n1 2 3 2", "line 2: \"c\" has a base and an apex that coincide or are too far apart"},
    {"ConeNan", "c 0 0 0 nan 1 1 1 1", "\"c\" has a coordinate"},
    {"TwoCorners", "p 2 0 0 0 1 1 1", "\"p\" has fewer than 3 corners"},
    {"NoCorners", "pp 0", "\"pp\" has fewer than 3 corners"},
    {"PolygonNan", "p 3 0 0 0 1 nan 0 1 1 nan", "\"p\" has a coordinate"},
};

INSTANTIATE_TEST_SUITE_P(Files, NffRepairTest, testing::ValuesIn(kNffRepairs),
                         [](const testing::TestParamInfo<NffRepair>& repair) { return repair.param.name; });

TEST_F(NffTest, WhatIsForgivenKeepsTheRest) {
  const Scene scene = load(
      "l 1 2 nan\nl 1 2 3\nv from 0 0 1 at 0 0 0 up 0 1 0 angle 45 resolution 0 3 hither -1\n"
      "f -1 0.5 nan 1 1e9 10 0 0\ns 0 0 0 1\n");
  ASSERT_THAT(scene.lights, SizeIs(1));
  EXPECT_EQ(scene.lights[0].diffuse, vec3(0.5F)) << "that of one source";
  ASSERT_THAT(scene.cameras, SizeIs(1));
  EXPECT_EQ(scene.cameras[0].resolution, uvec2(0));
  EXPECT_EQ(scene.cameras[0].near, 0.0F);
  EXPECT_EQ(scene.materials.at(0).phong().diffuse, vec3(0, 0.5F, 0));
  EXPECT_EQ(scene.materials.at(0).phong().specular, vec3(1e7F));
}

TEST_F(NffTest, AFileWhoseShapesAreAllLeftOutIsRefused) {
  EXPECT_THAT(refusal("s 0 0 0 0\np 1 0 0 0\n"), HasProblem("scene.geometry.none \"s\" radius"));
}

// The next tests check refusals.

class BadNffTest : public BadFileTest {};

TEST_P(BadNffTest, IsRefusedWithPlaceAndCure) {
  expect_refusal("bad.nff", GetParam().text);
}

const BadFile kBadNff[] = {
    {"UnknownStatement", "b 1 1 1\nq 1 2 3\n", "nff.statement.unknown \"q\"", ": line 2"},
    {"UpperCase", "S 0 0 0 1", "nff.statement.unknown \"S\"", ": line 1"},
    {"TooManyNumbers", "s 0 0 0 1\n 7", "nff.statement.unknown \"7\"", ": line 2"},
    {"NoNumber", "s 0 0\nx 1\n", "nff.number.wrong \"x\"", ": line 2"},
    {"ShapeOfThree", "s 0 0 0\ns 0 0 0 1", "nff.number.wrong \"s\"", ": line 2"},
    {"HugeCount", "p 99999999999999999999 0 0 0", "nff.corners.count", ": line 1"},
    {"LargeCount", "p 4000000000 0 0 0", "nff.corners.count", ": line 1"},
    {"NegativeCount", "pp -3 0 0 0", "nff.corners.count \"-3\"", ": line 1"},
    {"BrokenCount", "p 3.5 0 0 0", "nff.corners.count \"3.5\"", ": line 1"},
    {"CutInPolygon", "p 3 0 0 0\n1 1 1\n0 1\n", "nff.file.short \"p\"", ": line 3"},
    {"CutInPatch", "pp 3 0 0 0 0 0 1 1 1 1", "nff.file.short \"pp\"", ": line 1"},
    {"CutBeforeCount", "b 0 0 0\np", "nff.file.short \"p\"", ": line 2"},
    {"CutInMaterial", "f 1 1 1 0.5", "nff.file.short \"f\"", ": line 1"},
    {"CutInCone", "c 1 1 1 0.5 2 2 2", "nff.file.short \"c\"", ": line 1"},
    {"CutInView", "v\nfrom 0 0 1\nat 0", "nff.file.short \"v\"", ": line 3"},
    {"Binary", "\x01\x02\xff\n", "nff.statement.unknown", ": line 1"},
};

INSTANTIATE_TEST_SUITE_P(Files, BadNffTest, testing::ValuesIn(kBadNff), name_of_bad_file);

/// The parser stops at the first problem, so it reports only this problem.
TEST_F(NffTest, OneProblemIsTold) {
  EXPECT_THAT(refusal("s 0 0 0 x\nq\nq\n"), testing::Not(HasSubstr("\"q\"")));
}

}  // namespace
}  // namespace promin
