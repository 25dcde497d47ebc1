// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/motion_vectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "promin/motion.h"
#include "promin/shapes.h"
#include "support/moving_gltf.h"
#include "support/problems.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

/// Half of the height of the picture in pixels. The field of view is 90 degrees, so that it is also the distance of the
/// film in pixels.
constexpr double kHalf = 64.0;
/// The largest error in pixels. Positions of hits are fp32 numbers, of which a pixel has 1e5.
constexpr double kMostError = 1e-4;

/// A view of 16 x 128 pixels from (0, 0, 5) along -Z.
View make_motion_view() {
  View view;
  view.camera.eye = vec3(0.0F, 0.0F, 5.0F);
  view.camera.yfov = static_cast<float>(0.5 * std::numbers::pi);
  view.size = uvec2(16, 128);
  return view;
}

/// The AOVs of a picture whose pixels show these points of primitive 0 of object 0; all others show nothing.
Aovs make_aovs(const View& view, const std::vector<vec3>& points) {
  Aovs aovs;
  AovSet set;
  set.position = set.object = set.primitive = true;
  aovs.resize(size_t{view.size.x} * view.size.y, set);
  for (size_t i = 0; i < points.size(); ++i) {
    aovs.position[i] = points[i];
    aovs.object[i] = aovs.primitive[i] = 0;
  }
  return aovs;
}

/// Points of a unit sphere around the origin that an eye on the axis +Z sees.
std::vector<vec3> points_of_sphere() {
  std::vector<vec3> points;
  for (int i = 0; i < 12; ++i) {
    const double polar = 0.1 * i;
    points.emplace_back(std::sin(polar) * std::cos(i), std::sin(polar) * std::sin(i), std::cos(polar));
  }
  return points;
}

/// The place of a point in a picture of make_motion_view(), from the centre, to the right and upwards.
dvec2 place_of(const dvec3& p) {
  return kHalf * dvec2(p.x, p.y) / (5.0 - p.z);
}

void expect_moved(const vec2& got, const dvec2& wanted) {
  EXPECT_NEAR(double{got.x}, wanted.x, kMostError);
  EXPECT_NEAR(double{got.y}, wanted.y, kMostError);
}

TEST(AddMotionTest, OfASphereIsThatOfItsPoints) {
  const View view = make_motion_view();
  Scene scene;
  scene.add("ball", Sphere{});
  Scene next = scene;
  dmat4& moved = next.objects[0].world_from_object;
  moved = glm::translate(dmat4(1.0), dvec3(0.5, -0.25, 1.0));
  const std::vector<vec3> points = points_of_sphere();
  Aovs aovs = make_aovs(view, points);
  add_motion(scene, view, next, view.camera, aovs);
  for (size_t i = 0; i < points.size(); ++i) {
    const dvec3 p(points[i]);
    expect_moved(aovs.motion[i], place_of(p + dvec3(0.5, -0.25, 1.0)) - place_of(p));
  }
  EXPECT_EQ(aovs.motion[points.size()], vec2(0.0F)) << "a miss";
  // Its surface turns about the vertical axis: the nearest point moves to the right.
  moved = glm::rotate(dmat4(1.0), 0.1, dvec3(0.0, 1.0, 0.0));
  add_motion(scene, view, next, view.camera, aovs);
  EXPECT_GT(aovs.motion[0].x, 1.0F);
  for (size_t i = 0; i < points.size(); ++i) {
    const dvec3 p(points[i]);
    const dvec3 turned(std::cos(0.1) * p.x + std::sin(0.1) * p.z, p.y, std::cos(0.1) * p.z - std::sin(0.1) * p.x);
    expect_moved(aovs.motion[i], place_of(turned) - place_of(p));
  }
}

TEST(AddMotionTest, OfThingsThatRestIsExactlyZero) {
  const View view = make_motion_view();
  Scene scene;
  Object& ball = scene.add("ball", Sphere{});
  ball.world_from_object = glm::rotate(glm::scale(dmat4(1.0), dvec3(0.3)), 0.7, dvec3(1.0, 2.0, 3.0));
  Aovs aovs = make_aovs(view, points_of_sphere());
  add_motion(scene, view, scene, view.camera, aovs);
  for (const vec2& movement : aovs.motion) EXPECT_EQ(movement, vec2(0.0F));
  // The same place in the world has other coordinates in a scene with another center.
  Scene moved = scene;
  moved.center = dvec3(0.0, -2.0, 0.0);
  Camera next = view.camera;
  next.eye.y += 2.0F;
  add_motion(scene, view, moved, next, aovs);
  for (const vec2& movement : aovs.motion) EXPECT_EQ(movement, vec2(0.0F));
}

TEST(AddMotionTest, FollowsTheCamera) {
  const View view = make_motion_view();
  Scene scene;
  scene.add("ball", Sphere{});
  const std::vector<vec3> points = points_of_sphere();
  Aovs aovs = make_aovs(view, points);
  Camera next = view.camera;
  next.eye += vec3(0.25F, 0.5F, -1.0F);
  add_motion(scene, view, scene, next, aovs);
  for (size_t i = 0; i < points.size(); ++i) {
    const dvec3 p(points[i]);
    expect_moved(aovs.motion[i], place_of(p - dvec3(0.25, 0.5, -1.0)) - place_of(p));
  }
  // The camera zooms.
  next = view.camera;
  next.yfov = static_cast<float>(2.0 * std::atan(0.5));
  add_motion(scene, view, scene, next, aovs);
  for (size_t i = 0; i < points.size(); ++i) expect_moved(aovs.motion[i], place_of(dvec3(points[i])));
  // A parallel projection, in which a unit of length has 64 pixels.
  View parallel = view;
  parallel.camera.projection = Projection::kOrthographic;
  next = parallel.camera;
  next.eye += vec3(0.25F, 0.5F, -1.0F);
  add_motion(scene, parallel, scene, next, aovs);
  for (size_t i = 0; i < points.size(); ++i) expect_moved(aovs.motion[i], {-16.0, -32.0});
}

TEST(AddMotionTest, TheSkyTurnsWithThePerspectiveCamera) {
  View view = make_motion_view();
  Scene scene;
  scene.environment.sky = GradientSky{};
  scene.environment.shows_sky = true;
  Aovs aovs = make_aovs(view, {});
  Camera next = view.camera;
  next.eye.x += 100.0F;
  const double angle = 0.1;
  next.look = vec3(dvec3(std::sin(angle), 0.0, -std::cos(angle)));
  add_motion(scene, view, scene, next, aovs);
  const size_t at = 63 * 16 + 9;  // 1.5 pixels to the right of the centre, and half a pixel above it
  const double turned = std::atan(1.5 / kHalf) - angle;
  const double shrunk = std::cos(turned + angle) / std::cos(turned);
  expect_moved(aovs.motion[at], {kHalf * std::tan(turned) - 1.5, 0.5 * shrunk - 0.5});
  view.crop = PixelWindow{uvec2(9, 63), uvec2(10, 64)};
  Aovs one;
  AovSet set;
  set.position = set.object = set.primitive = true;
  one.resize(1, set);
  add_motion(scene, view, scene, next, one);
  EXPECT_EQ(one.motion[0], aovs.motion[at]) << "a crop has the numbers of the whole picture";
  scene.environment.shows_sky = false;
  add_motion(scene, view, scene, next, one);
  EXPECT_EQ(one.motion[0], vec2(0.0F)) << "one colour does not move";
  scene.environment.shows_sky = true;
  next.projection = view.camera.projection = Projection::kOrthographic;
  add_motion(scene, view, scene, next, one);
  EXPECT_EQ(one.motion[0], vec2(0.0F));
}

TEST(AddMotionTest, IsFiniteEverywhere) {
  const View view = make_motion_view();
  Scene scene;
  scene.add("ball", Sphere{});
  const std::vector<vec3> points = points_of_sphere();
  Aovs aovs = make_aovs(view, points);
  Camera next = view.camera;
  // The points lie behind the eye of the next frame, or beside it.
  for (const float z : {-20.0F, points[0].z, 1.0F}) {
    next.eye.z = z;
    add_motion(scene, view, scene, next, aovs);
    for (const vec2& movement : aovs.motion) {
      EXPECT_TRUE(std::isfinite(movement.x) && std::isfinite(movement.y)) << z;
    }
    // The first point lies at the eye in one of the frames, and all of them lie behind it in another.
    EXPECT_EQ(aovs.motion[z < -1.0F ? 3 : 0], vec2(0.0F)) << z;
  }
  // The next frame does not show the object, or does not have it.
  Scene hidden = scene;
  hidden.objects[0].geometry = Object::kNoGeometry;
  hidden.objects[0].world_from_object = dmat4(0.0);
  add_motion(scene, view, hidden, view.camera, aovs);
  EXPECT_EQ(aovs.motion[3], vec2(0.0F));
  add_motion(scene, view, Scene(), view.camera, aovs);
  EXPECT_EQ(aovs.motion[3], vec2(0.0F));
}

/// Returns a triangle with these corners.
Mesh make_triangle(const vec3& a, const vec3& b, const vec3& c) {
  Mesh mesh;
  mesh.positions = {a, b, c};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(AddMotionTest, OfAMeshThatChangesItsFormFollowsItsCorners) {
  const View view = make_motion_view();
  Scene scene;
  Object& object = scene.add("strip", make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  object.world_from_object = glm::scale(dmat4(1.0), dvec3(2.0, 2.0, 2.0));
  Scene next = scene;
  next.geometries[0] = make_triangle({0, 0, 1}, {1, 0.5F, 0}, {-0.25F, 1, 0});
  next.objects[0].world_from_object = glm::translate(dmat4(1.0), dvec3(0.0, 0.0, 0.5));
  const dvec3 corners[] = {{0, 0, 1.5}, {1, 0.5, 0.5}, {-0.25, 1, 0.5}};
  std::vector<vec3> points;
  for (int i = 0; i < 9; ++i) points.emplace_back(0.2 * (i % 3), 0.2 * (i / 3.0), 0.0);
  Aovs aovs = make_aovs(view, points);
  add_motion(scene, view, next, view.camera, aovs);
  for (size_t i = 0; i < points.size(); ++i) {
    const dvec3 p(points[i]);
    const dvec3 moved = (1.0 - 0.5 * p.x - 0.5 * p.y) * corners[0] + 0.5 * p.x * corners[1] + 0.5 * p.y * corners[2];
    expect_moved(aovs.motion[i], place_of(moved) - place_of(p));
  }
  // Rounding puts a point beside a triangle that is almost a line; the point follows the edge.
  std::get<Mesh>(scene.geometries[0]) = make_triangle({0, 0, 0}, {1, 0, 0}, {0.5F, 1e-30F, 0});
  add_motion(scene, view, next, view.camera, aovs);
  for (const vec2& movement : aovs.motion) EXPECT_LT(glm::length(movement), 128.0F);
}

class AddMotionOfFileTest : public SceneFolder {};

/// Two joints bend a strip. The reference is the weighted mean of the joints' transforms at a vertex, and linear
/// between vertices.
TEST_F(AddMotionOfFileTest, ASkinnedStrip) {
  GltfBuilder gltf;
  const size_t positions = gltf.add<float>({0, 0, 0, 1, 0, 0, 0, 2, 0}, "VEC3");
  const size_t triangles = gltf.add<uint16_t>({0, 1, 2}, "SCALAR");
  const size_t joints = gltf.add<uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4");
  const size_t weights = gltf.add<float>({1, 0, 0, 0, 0.25F, 0.75F, 0, 0, 0, 1, 0, 0}, "VEC4");
  gltf.show({{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
             {"indices", triangles}});
  gltf.add_node({{"children", {2}}});
  gltf.add_node({{"name", "tip"}});
  gltf.json["nodes"][0]["skin"] = 0;
  gltf.json["skins"] = {{{"joints", {1, 2}}}};
  test::animate(gltf, 0, "/nodes/2/translation", {0, 1}, {0, 0, 0, 4, 0, -2}, "VEC3");
  const Scene scene = load_scene(write("strip.gltf", gltf.text()));
  const Scene now = scene_at(scene, {.animations = {0}, .time_s = 0.25});
  const Scene then = scene_at(scene, {.animations = {0}, .time_s = 0.5});
  const auto corner_at = [](const dvec3& p, double weight, double time_s) {
    return p + weight * time_s * dvec3(4.0, 0.0, -2.0);
  };
  const auto point_at = [&](double time_s) {
    return 0.5 * corner_at({0, 0, 0}, 0.0, time_s) + 0.25 * corner_at({1, 0, 0}, 0.75, time_s) +
           0.25 * corner_at({0, 2, 0}, 1.0, time_s);
  };
  const View view = make_motion_view();
  Aovs aovs = make_aovs(view, {vec3(point_at(0.25))});
  add_motion(now, view, then, view.camera, aovs);
  expect_moved(aovs.motion[0], place_of(point_at(0.5)) - place_of(point_at(0.25)));
  EXPECT_GT(glm::length(aovs.motion[0]), 4.0F);
}

TEST(AddMotionTest, RefusesOtherPicturesAndScenes) {
  const View view = make_motion_view();
  Scene scene;
  scene.add("triangle", make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  Aovs aovs = make_aovs(view, {vec3(0.25F, 0.25F, 0.0F)});
  Aovs few = aovs;
  few.position.pop_back();
  EXPECT_THAT([&] { add_motion(scene, view, scene, view.camera, few); }, FailsWith("motion.aovs"));
  Scene other = scene;
  std::get<Mesh>(other.geometries[0]).positions.emplace_back(1.0F);
  EXPECT_THAT([&] { add_motion(scene, view, other, view.camera, aovs); }, FailsWith("motion.next.other"));
  EXPECT_THAT([&] { add_motion(Scene(), view, scene, view.camera, aovs); }, FailsWith("motion.next.other"));
}

}  // namespace
}  // namespace promin
