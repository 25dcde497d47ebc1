// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/framing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "promin/error.h"
#include "scene/framing.h"

namespace promin {
namespace {

constexpr float kAspectRatios[] = {16.0F / 9.0F, 1.0F, 9.0F / 16.0F};

/// The range of points in the picture, whose sides are at -1 and 1.
struct Extent {
  dvec2 lo{std::numeric_limits<double>::infinity()};
  dvec2 hi{-std::numeric_limits<double>::infinity()};
  bool is_behind = false;

  double longer_side() const { return 0.5 * std::max(hi.x - lo.x, hi.y - lo.y); }
  dvec2 middle() const { return 0.5 * (lo + hi); }
};

Extent project(const std::vector<dvec3>& points, const Camera& camera, float aspect_ratio) {
  const dvec3 look(camera.look);
  const dvec3 up(camera.up);
  const dvec3 right = glm::cross(look, up);
  const bool is_parallel = camera.projection == Projection::kOrthographic;
  const double half_height = is_parallel ? double{camera.ymag} : std::tan(0.5 * static_cast<double>(camera.yfov));
  Extent extent;
  for (const dvec3& point : points) {
    const dvec3 v = point - dvec3(camera.eye);
    const double depth = glm::dot(v, look);
    extent.is_behind |= depth <= 0.0;
    const double size = half_height * (is_parallel ? 1.0 : depth);
    const dvec2 at(glm::dot(v, right) / (size * static_cast<double>(aspect_ratio)), glm::dot(v, up) / size);
    extent.lo = glm::min(extent.lo, at);
    extent.hi = glm::max(extent.hi, at);
  }
  return extent;
}

/// A scene and points of its surface, including those that reach farthest.
struct Model {
  std::string name;
  Scene scene;
  std::vector<dvec3> points;
};

Model make_cloud(const std::string& name, const dvec3& size, const dvec3& place, size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<float> spread;
  Mesh mesh;
  for (size_t i = 0; i < count; ++i) {
    mesh.positions.emplace_back(spread(random), spread(random), spread(random));
    if (i >= 2) mesh.triangles.emplace_back(i - 2, i - 1, i);
  }
  // No triangle uses this vertex.
  mesh.positions.emplace_back(1e3F);
  dmat4 matrix(1.0);
  for (int i = 0; i < 3; ++i) matrix[i][i] = size[i];
  matrix[0][1] = 0.3 * size.x;
  matrix[3] = dvec4(place, 1.0);
  Model model{name, {}, {}};
  for (size_t i = 0; i < count; ++i) {
    model.points.push_back(dvec3(matrix * dvec4(dvec3(mesh.positions[i]), 1.0)));
  }
  model.scene.add("cloud", std::move(mesh), 0, matrix);
  return model;
}

/// Returns a box that is turned a little.
Model make_rod(const std::string& name, const vec3& size) {
  dmat4 matrix(1.0);
  matrix[0][1] = 0.2;
  matrix[2][0] = 1e-3;
  Model model{name, {}, {}};
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(size * vec3((i & 1) != 0 ? 1 : 0, (i & 2) != 0 ? 1 : 0, (i & 4) != 0 ? 1 : 0));
    model.points.push_back(dvec3(matrix * dvec4(dvec3(mesh.positions.back()), 1.0)));
  }
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {5, 6, 7}};
  model.scene.add("rod", std::move(mesh), 0, matrix);
  return model;
}

/// Returns shapes of all kinds, each with points close together on it.
Model make_shapes() {
  Model model{"shapes", {}, {}};
  const dvec3 axis = glm::normalize(dvec3(1, 2, -1));
  const dvec3 side = glm::normalize(glm::cross(axis, dvec3(0, 1, 0)));
  const dvec3 other = glm::cross(axis, side);
  model.scene.add("sphere", Sphere{.center = dvec3(3, 0, 0), .radius = 1.5});
  model.scene.add("cylinder", Cylinder{.center = dvec3(-2, 1, 0), .axis = axis, .half_height = 1.0, .radius = 0.5});
  model.scene.add("cone", Cone{.center = dvec3(0, -2, 2), .axis = axis, .half_height = 1.0, .radius_bottom = 0.75});
  model.scene.add("capsule", Capsule{.center = dvec3(0, 3, -1), .axis = axis, .half_height = 1.0, .radius_top = 0.5});
  model.scene.add("box", Box{.center = dvec3(0, 0, 3), .half_size = dvec3(0.5, 1, 0.25)});
  model.scene.add("floor", Plane{});
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    const dvec3 around = std::cos(angle) * side + std::sin(angle) * other;
    for (const double end : {-1.0, 1.0}) model.points.push_back(dvec3(-2, 1, 0) + end * axis + 0.5 * around);
    model.points.push_back(dvec3(0, -2, 2) - axis + 0.75 * around);
    for (int k = 0; k <= kSteps / 2; ++k) {
      const double tilt = std::numbers::pi * k / (kSteps / 2);
      const dvec3 out = std::cos(tilt) * axis + std::sin(tilt) * around;
      model.points.push_back(dvec3(3, 0, 0) + 1.5 * out);
      model.points.push_back(dvec3(0, 3, -1) - axis + 0.25 * out);
      model.points.push_back(dvec3(0, 3, -1) + axis + 0.5 * out);
    }
  }
  model.points.push_back(dvec3(0, -2, 2) + axis);
  for (int corner = 0; corner < 8; ++corner) {
    model.points.push_back(dvec3(0, 0, 3) + dvec3((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 1.0 : -1.0,
                                                  (corner & 4) != 0 ? 0.25 : -0.25));
  }
  return model;
}

std::vector<Model> make_models() {
  std::vector<Model> models;
  models.push_back(make_cloud("round", dvec3(1), dvec3(0), 500));
  models.push_back(make_rod("long", vec3(0.01F, 0.02F, 5.0F)));
  models.push_back(make_rod("high", vec3(0.1F, 20.0F, 0.2F)));
  models.push_back(make_cloud("flat", dvec3(5, 0.01, 4), dvec3(-3, 0, 0), 500));
  models.push_back(make_cloud("small and far away", dvec3(1e-3), dvec3(10, -20, 30), 500));
  models.push_back(make_shapes());
  return models;
}

void expect_framed(const Model& model, const Camera& camera, float aspect_ratio, double fit, const std::string& from) {
  const Extent extent = project(model.points, camera, aspect_ratio);
  const std::string name = model.name + " from " + from + " at " + std::to_string(aspect_ratio);
  EXPECT_FALSE(extent.is_behind) << name;
  EXPECT_NEAR(extent.longer_side(), fit, 0.01 * fit) << name;
  EXPECT_NEAR(extent.middle().x, 0.0, 0.005) << name;
  EXPECT_NEAR(extent.middle().y, 0.0, 0.005) << name;
}

TEST(FramingTest, TheLongerSideOfAnyModelCoversTheShareAskedFor) {
  for (const Model& model : make_models()) {
    for (const float aspect_ratio : kAspectRatios) {
      for (size_t from = 0; from < static_cast<size_t>(Framing::kInside); ++from) {
        const FrameOptions options{.from = static_cast<Framing>(from)};
        const std::string name(framing_names()[from]);
        expect_framed(model, frame_scene(model.scene, aspect_ratio, options), aspect_ratio, 0.85, name);
      }
      expect_framed(model, frame_scene(model.scene, aspect_ratio, {.fit = 0.3F}), aspect_ratio, 0.3, "no side");
    }
  }
}

TEST(FramingTest, AnyCameraIsFitted) {
  for (const Model& model : make_models()) {
    for (const float aspect_ratio : kAspectRatios) {
      Camera camera;
      camera.look = glm::normalize(vec3(0.3F, -2.0F, 0.9F));
      camera.up = glm::normalize(glm::cross(camera.look, vec3(1.0F, 1.0F, 0.0F)));
      camera.yfov = 1.2F;
      expect_framed(model, fit_camera(model.scene, camera, aspect_ratio, 1.0F), aspect_ratio, 1.0, "a wide lens");
      camera.projection = Projection::kOrthographic;
      expect_framed(model, fit_camera(model.scene, camera, aspect_ratio), aspect_ratio, 0.85, "far away");
    }
  }
}

TEST(FramingTest, ATurningCameraShowsTheSceneFromAllSidesAtOneDistance) {
  constexpr int kSteps = 60;
  for (const Model& model : make_models()) {
    for (const float aspect_ratio : kAspectRatios) {
      for (const vec3 up : {vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 2, -1)}) {
        const Camera first =
            fit_turning_camera(model.scene, frame_scene(model.scene, aspect_ratio, {.up = up}), up, aspect_ratio, 0.9F);
        const dvec3 middle = middle_of(frame_of(model.scene));
        Extent all;
        for (int i = 0; i < kSteps; ++i) {
          const Camera camera = orbit_camera(first, middle, {.azimuth_deg = 360.0 * i / kSteps}, up);
          const Extent one = project(model.points, camera, aspect_ratio);
          all.is_behind |= one.is_behind;
          all.lo = glm::min(all.lo, one.lo);
          all.hi = glm::max(all.hi, one.hi);
        }
        EXPECT_FALSE(all.is_behind) << model.name;
        EXPECT_NEAR(all.longer_side(), 0.9, 0.01) << model.name << " at " << aspect_ratio;
        EXPECT_NEAR(all.middle().x, 0.0, 0.005) << model.name << " at " << aspect_ratio;
        EXPECT_NEAR(all.middle().y, 0.0, 0.005) << model.name << " at " << aspect_ratio;
      }
    }
  }
}

TEST(FramingTest, WhatPointsAtTheEyeKeepsADistance) {
  Scene scene;
  scene.add("needle", Cone{.center = dvec3(0), .axis = dvec3(0, 0, 1), .half_height = 5.0, .radius_bottom = 0.5});
  const Camera camera = frame_scene(scene, 1.0F, {.from = Framing::kFront});
  EXPECT_NEAR(camera.eye.z, 5.0 + 0.5 / (256.0 * 0.85 * std::tan(glm::radians(20.0))), 1e-4) << "its tip is at 5";
}

TEST(FramingTest, StrayGeometryIsLeftOut) {
  Model model = make_cloud("round", dvec3(1), dvec3(0), 500);
  Mesh stray;
  stray.positions = {vec3(5000, 0, 0), vec3(5000.1F, 0, 0), vec3(5000, 0.1F, 0)};
  stray.triangles = {{0, 1, 2}};
  model.scene.add("stray", stray);
  model.scene.add("stray ball", Sphere{.center = dvec3(0, 7000, 0), .radius = 0.01});
  expect_framed(model, frame_scene(model.scene, 1.0F), 1.0F, 0.85, "no side");
}

/// Returns the direction from the scene to a camera, and the up direction for it.
std::pair<vec3, vec3> side_of(const Scene& scene, Framing from, const vec3& up = vec3(0, 1, 0)) {
  const Camera camera = frame_scene(scene, 1.0F, {.from = from, .up = up});
  return {-camera.look, camera.up};
}

TEST(FramingTest, SidesAreThoseOfAViewerInFront) {
  Scene scene;
  scene.add("ball", Sphere());
  const vec3 x(1, 0, 0);
  const vec3 y(0, 1, 0);
  const vec3 z(0, 0, 1);
  EXPECT_EQ(side_of(scene, Framing::kFront), std::pair(z, y));
  EXPECT_EQ(side_of(scene, Framing::kBack), std::pair(-z, y));
  EXPECT_EQ(side_of(scene, Framing::kLeft), std::pair(-x, y));
  EXPECT_EQ(side_of(scene, Framing::kRight), std::pair(x, y));
  EXPECT_EQ(side_of(scene, Framing::kTop), std::pair(y, -z));
  EXPECT_EQ(side_of(scene, Framing::kBottom), std::pair(-y, z));
  EXPECT_EQ(side_of(scene, Framing::kFront, z), std::pair(-y, z)) << "as programs have it whose up is Z";
  EXPECT_EQ(side_of(scene, Framing::kRight, z), std::pair(x, z));
  EXPECT_EQ(side_of(scene, Framing::kFront, -y), std::pair(z, -y));
  EXPECT_EQ(side_of(scene, Framing::kFront, 7.0F * x), std::pair(z, x));
  EXPECT_EQ(side_of(scene, Framing::kFront, -z), std::pair(y, -z));
}

TEST(FramingTest, WhatIsNoFramingIsRefused) {
  Scene scene;
  scene.add("ball", Sphere());
  EXPECT_THROW(frame_scene(scene, -1.0F), UsageError);
  EXPECT_THROW(frame_scene(scene, 1.0F, {.fit = 1.1F}), UsageError);
  EXPECT_THROW(frame_scene(scene, 1.0F, {.fit = std::nanf("")}), UsageError);
  EXPECT_THROW(frame_scene(scene, 1.0F, {.up = vec3(0.0F)}), UsageError);
}

TEST(FramingTest, ALonePointAndALineAlongTheViewAreSeen) {
  Scene point;
  Mesh mesh;
  mesh.positions = {vec3(1), vec3(1), vec3(1)};
  mesh.triangles = {{0, 1, 2}};
  point.add("point", mesh);
  EXPECT_FALSE(project({dvec3(1)}, frame_scene(point, 1.0F, {.from = Framing::kFront}), 1.0F).is_behind);
  Scene line;
  mesh.positions = {vec3(0), vec3(0, 0, 1), vec3(0, 0, 2)};
  line.add("line", mesh);
  const Camera camera = frame_scene(line, 1.0F, {.from = Framing::kFront});
  EXPECT_FALSE(project({dvec3(0), dvec3(0, 0, 2)}, camera, 1.0F).is_behind);
}

// The next tests look from within scenes.

/// Adds a box of 12 triangles whose fronts face outwards or inwards.
void add_mesh_box(Scene& scene, const vec3& lo, const vec3& hi, bool faces_inwards = false) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1) != 0 ? hi.x : lo.x, (i & 2) != 0 ? hi.y : lo.y, (i & 4) != 0 ? hi.z : lo.z);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (uvec3& triangle : mesh.triangles) {
    if (faces_inwards) std::swap(triangle.y, triangle.z);
  }
  scene.add("box", std::move(mesh));
}

Scene make_room(const vec3& size) {
  Scene scene;
  scene.materials.resize(1);
  add_mesh_box(scene, vec3(0), size, true);
  const vec3 table = size * vec3(0.2F, 0.3F, 0.2F);
  add_mesh_box(scene, vec3(1, 0, 1), vec3(1, 0, 1) + table);
  scene.add("lamp", Sphere{.center = dvec3(size) * dvec3(0.7, 0.8, 0.5), .radius = 0.2});
  return scene;
}

TEST(InteriorTest, OneStandsInARoom) {
  const Scene deep = make_room(vec3(6, 3, 9));
  EXPECT_EQ(framing_of(deep), Framing::kInside);
  const Camera camera = frame_scene(deep, 1.5F);
  EXPECT_EQ(camera.eye, vec3(3.0F, 1.5F, 6.0F)) << "a third of 9 from the end";
  EXPECT_EQ(camera.look, vec3(0, 0, -1));
  EXPECT_NEAR(camera.yfov, std::numbers::pi / 3.0, 1e-6);
  const Camera across = frame_scene(make_room(vec3(9, 3, 6)), 1.5F);
  EXPECT_EQ(across.eye, vec3(6.0F, 1.5F, 3.0F));
  EXPECT_EQ(across.look, vec3(-1, 0, 0));
  EXPECT_EQ(frame_scene(deep, 1.5F, {.from = Framing::kFront}).look, vec3(0, 0, -1));
  EXPECT_GT(frame_scene(deep, 1.5F, {.from = Framing::kFront}).eye.z, 9.0F) << "who says from where is outside";
}

TEST(InteriorTest, ARoomMayBeMirroredAndCutFinely) {
  Scene room = make_room(vec3(6, 3, 9));
  for (Object& object : room.objects) {
    for (int i = 0; i < 3; ++i) object.world_from_object[i][i] = -2.0;
  }
  EXPECT_EQ(framing_of(room), Framing::kInside);

  constexpr uint32_t kCuts = 100;
  Mesh dome;
  for (uint32_t i = 0; i <= kCuts; ++i) {
    for (uint32_t k = 0; k <= kCuts; ++k) {
      const double around = 2.0 * std::numbers::pi * k / kCuts;
      const double down = std::numbers::pi * i / kCuts;
      dome.positions.emplace_back(9.0 * std::sin(down) * std::sin(around), 9.0 * std::cos(down),
                                  9.0 * std::sin(down) * std::cos(around));
    }
  }
  for (uint32_t i = 0; i < kCuts; ++i) {
    for (uint32_t k = 0; k < kCuts; ++k) {
      const uint32_t at = i * (kCuts + 1) + k;
      dome.triangles.emplace_back(at, at + 1, at + kCuts + 1);
      dome.triangles.emplace_back(at + 1, at + kCuts + 2, at + kCuts + 1);
    }
  }
  Scene scene;
  scene.add("dome", dome);
  EXPECT_EQ(framing_of(scene), Framing::kThreeQuarter) << "nothing is in it";
  add_mesh_box(scene, vec3(-1), vec3(1));
  EXPECT_EQ(framing_of(scene), Framing::kInside);
}

/// Returns a room without the wall at one end of an axis.
Scene make_open_room(int axis, float end) {
  Scene room = make_room(vec3(6, 3, 9));
  auto& walls = std::get<Mesh>(room.geometries.front());
  std::erase_if(walls.triangles, [&](const uvec3& t) {
    return walls.positions[t.x][axis] == end && walls.positions[t.y][axis] == end && walls.positions[t.z][axis] == end;
  });
  return room;
}

TEST(InteriorTest, ARoomIsSeenThroughItsOpenSide) {
  EXPECT_EQ(framing_of(make_open_room(2, 0.0F)), Framing::kBack);
  EXPECT_EQ(framing_of(make_open_room(2, 9.0F)), Framing::kFront);
  EXPECT_EQ(framing_of(make_open_room(0, 0.0F)), Framing::kLeft);
  EXPECT_EQ(framing_of(make_open_room(0, 6.0F)), Framing::kRight);
  EXPECT_EQ(framing_of(make_open_room(1, 3.0F)), Framing::kInside) << "it has no ceiling";
  const Camera camera = frame_scene(make_open_room(2, 0.0F), 1.5F);
  EXPECT_EQ(camera.look, vec3(0, 0, 1));
  EXPECT_LT(camera.eye.z, 0.0F);
}

TEST(InteriorTest, AnObjectIsSeenFromOutside) {
  Scene box;
  add_mesh_box(box, vec3(-1), vec3(1));
  EXPECT_EQ(framing_of(box), Framing::kThreeQuarter);
  add_mesh_box(box, vec3(-0.5F), vec3(0.5F));
  EXPECT_EQ(framing_of(box), Framing::kThreeQuarter) << "closed, with something in it";

  Scene turned;
  add_mesh_box(turned, vec3(-1), vec3(1), true);
  EXPECT_EQ(framing_of(turned), Framing::kThreeQuarter) << "empty";
  add_mesh_box(turned, vec3(-0.5F), vec3(0.5F), true);
  EXPECT_EQ(framing_of(turned), Framing::kThreeQuarter) << "all of it is turned inside out";

  Scene doll_house = make_room(vec3(6, 3, 9));
  doll_house.materials[0].is_double_sided = false;
  EXPECT_EQ(framing_of(doll_house), Framing::kThreeQuarter) << "its walls are not seen from outside";

  Scene walled = make_room(vec3(6, 3, 9));
  add_mesh_box(walled, vec3(-0.1F), vec3(6.1F, 3.1F, 9.1F));
  EXPECT_EQ(framing_of(walled), Framing::kThreeQuarter) << "its walls have outsides";
}

// The next tests use other cameras.

TEST(OrbitTest, TurnsAroundThePointAndLeavesItWhereItWas) {
  Camera camera;
  camera.eye = vec3(0, 0, 5);
  const auto expect_at = [&](const Orbit& orbit, const dvec3& eye, const dvec3& up) {
    const Camera turned = orbit_camera(camera, dvec3(0.0), orbit);
    EXPECT_NEAR(glm::length(dvec3(turned.eye) - eye), 0.0, 1e-6);
    EXPECT_NEAR(glm::length(dvec3(turned.look) + glm::normalize(eye)), 0.0, 1e-6);
    EXPECT_NEAR(glm::length(dvec3(turned.up) - up), 0.0, 1e-6);
  };
  expect_at({.azimuth_deg = 90.0}, {5, 0, 0}, {0, 1, 0});
  expect_at({.elevation_deg = 90.0}, {0, 5, 0}, {0, 0, -1});
  expect_at({.azimuth_deg = 90.0, .elevation_deg = 90.0}, {0, 5, 0}, {-1, 0, 0});
  expect_at({.elevation_deg = 180.0}, {0, 0, -5}, {0, -1, 0});
  expect_at({.roll_deg = 90.0}, {0, 0, 5}, {-1, 0, 0});
  const double c = 5.0 * std::sqrt(0.5);
  expect_at({.azimuth_deg = -45.0}, {-c, 0, c}, {0, 1, 0});
  camera.look = vec3(0.6F, 0.0F, -0.8F);
  EXPECT_EQ(orbit_camera(camera, dvec3(7.0), {}).look, camera.look);
}

TEST(OrbitTest, ACameraIsTurnedAroundWhatItLooksAt) {
  Scene scene;
  scene.add("ball", Sphere{.center = dvec3(1, 0, 0), .radius = 1.0});
  Camera camera;
  camera.eye = vec3(0, 0, 5);
  EXPECT_EQ(orbit_target(scene, camera), dvec3(0, 0, 0)) << "not the middle, which is beside its axis";
  camera.eye = vec3(0, 0, -5);
  EXPECT_EQ(orbit_target(scene, camera), dvec3(1, 0, 0)) << "it looks away";
}

TEST(WidenTest, ANarrowerPictureSeesMoreAboveAndBelow) {
  Camera camera;
  camera.yfov = 0.7F;
  camera.ymag = 2.0F;
  camera.aspect_ratio = 16.0F / 9.0F;
  EXPECT_EQ(widen_camera(camera, uvec2(1280, 720)).yfov, 0.7F);
  EXPECT_EQ(widen_camera(camera, uvec2(1000, 563)).yfov, 0.7F) << "rounded";
  EXPECT_EQ(widen_camera(camera, uvec2(2000, 500)).yfov, 0.7F) << "wider";
  const Camera square = widen_camera(camera, uvec2(500, 500));
  EXPECT_NEAR(std::tan(0.5F * square.yfov), std::tan(0.35F) * 16.0F / 9.0F, 1e-6) << "as wide as before";
  EXPECT_FLOAT_EQ(square.ymag, 32.0F / 9.0F);
  camera.aspect_ratio = 0.0F;
  EXPECT_EQ(widen_camera(camera, uvec2(10, 500)).yfov, 0.7F);
}

TEST(MaySeeTest, OnlyWhatLiesInThePictureIsSeen) {
  Scene scene;
  add_mesh_box(scene, vec3(-1), vec3(1));
  Camera camera;
  camera.eye = vec3(0, 0, 5);
  EXPECT_TRUE(may_see(scene, camera, 1.0F));
  camera.near = 7.0F;
  EXPECT_FALSE(may_see(scene, camera, 1.0F)) << "before the near plane";
  camera.near = 0.0F;
  camera.look = vec3(0, 0, 1);
  EXPECT_FALSE(may_see(scene, camera, 1.0F)) << "behind";
  camera.look = vec3(1, 0, 0);
  EXPECT_FALSE(may_see(scene, camera, 1.0F)) << "beside";
  camera.look = vec3(0, 0, -1);
  camera.eye = vec3(0);
  EXPECT_TRUE(may_see(scene, camera, 1.0F)) << "within, where no corner is in the picture";
  camera.projection = Projection::kOrthographic;
  camera.eye = vec3(5, 0, 5);
  EXPECT_FALSE(may_see(scene, camera, 1.0F));
  EXPECT_TRUE(may_see(scene, camera, 5.0F));
  camera.projection = Projection::kPerspective;
  camera.look = vec3(1, 0, 0);
  scene.add("ball", Sphere{.center = dvec3(9, 0, 5), .radius = 0.01});
  EXPECT_TRUE(may_see(scene, camera, 1.0F));
}

TEST(MaySeeTest, APlaneIsSeenBelowTheHorizon) {
  Scene scene;
  scene.add("floor", Plane{});
  Camera camera;
  camera.eye = vec3(0, 1, 0);
  EXPECT_TRUE(may_see(scene, camera, 1.0F));
  camera.look = vec3(0, 1, 0);
  camera.up = vec3(0, 0, 1);
  EXPECT_FALSE(may_see(scene, camera, 1.0F));
  camera.projection = Projection::kOrthographic;
  EXPECT_FALSE(may_see(scene, camera, 1.0F));
  camera.look = vec3(0, -1, 0);
  EXPECT_TRUE(may_see(scene, camera, 1.0F));
}

}  // namespace
}  // namespace promin
