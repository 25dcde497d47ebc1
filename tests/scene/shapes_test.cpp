// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/shapes.h"
#include "promin/framing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/rounding.h"
#include "scene/world_scene.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

/// Extends bounds by a disk, in double. It uses the disk's extreme points along each axis: center +- radius * (e_i -
/// a_i a) / |e_i - a_i a|.
void extend_by_disk(const dvec3& center, const dvec3& a, double radius, dvec3& lo, dvec3& hi) {
  for (int i = 0; i < 3; ++i) {
    dvec3 toward(0.0);
    toward[i] = 1.0;
    toward -= a[i] * a;
    const double length = glm::length(toward);
    const dvec3 reach = length > 1e-300 ? radius / length * toward : dvec3(0.0);
    lo = glm::min(lo, glm::min(center - reach, center + reach));
    hi = glm::max(hi, glm::max(center - reach, center + reach));
  }
}

void expect_tight(const Bounds& bounds, const dvec3& lo, const dvec3& hi, double size) {
  for (int i = 0; i < 3; ++i) {
    const double slack = 8.0 * kUnitRoundoff * (std::max(std::abs(lo[i]), std::abs(hi[i])) + size);
    EXPECT_LE(bounds.lo[i], lo[i]);
    EXPECT_GE(bounds.lo[i], lo[i] - slack);
    EXPECT_GE(bounds.hi[i], hi[i]);
    EXPECT_LE(bounds.hi[i], hi[i] + slack);
  }
}

class RandomShapes : public testing::TestWithParam<double> {
 protected:
  float number(double lo, double hi) { return static_cast<float>(std::uniform_real_distribution<>(lo, hi)(random_)); }
  vec3 center() { return GetParam() * dvec3(number(-1, 1), number(-1, 1), number(-1, 1)); }
  vec3 axis() {
    // Every other axis is close to a coordinate axis, where sqrt(1 - a^2) cancels.
    dvec3 axis(number(-1, 1), number(-1, 1), number(-1, 1));
    if (random_() % 2 == 0) axis[static_cast<int>(random_() % 3)] *= 5000.0;
    return vec3(glm::normalize(axis));
  }

  std::mt19937 random_{7};
};

TEST_P(RandomShapes, BoundsOfConesAndCylindersAreConservativeAndTight) {
  for (int i = 0; i < 1000; ++i) {
    const world::Cone cone{center(), axis(), number(0.1, 2), number(0, 2), number(0, 2)};
    const dvec3 a = glm::normalize(dvec3(cone.axis));
    dvec3 lo(std::numeric_limits<double>::infinity());
    dvec3 hi = -lo;
    extend_by_disk(dvec3(cone.center) - double{cone.half_height} * a, a, cone.radius_bottom, lo, hi);
    extend_by_disk(dvec3(cone.center) + double{cone.half_height} * a, a, cone.radius_top, lo, hi);
    expect_tight(bounds_of(cone), lo, hi, 4.0);

    const world::Cylinder cylinder{cone.center, cone.axis, cone.half_height, cone.radius_top};
    const world::Cone same{cone.center, cone.axis, cone.half_height, cone.radius_top, cone.radius_top};
    EXPECT_EQ(bounds_of(cylinder).lo, bounds_of(same).lo);
    EXPECT_EQ(bounds_of(cylinder).hi, bounds_of(same).hi);
  }
}

TEST_P(RandomShapes, BoundsOfSpheresAreConservativeAndTight) {
  for (int i = 0; i < 1000; ++i) {
    const world::Sphere sphere{center(), number(0.001, 2)};
    expect_tight(bounds_of(sphere), dvec3(sphere.center) - double{sphere.radius},
                 dvec3(sphere.center) + double{sphere.radius}, sphere.radius);
  }
}

INSTANTIATE_TEST_SUITE_P(Offsets, RandomShapes, testing::Values(0.0, 1.0, 1e3, 1e7),
                         [](const auto& offset) { return "Offset" + std::to_string(offset.index); });

TEST(ShapesTest, AxisAlignedDisksDoNotBulge) {
  const Bounds bounds = bounds_of(world::Cylinder{vec3(0), vec3(0, 1, 0), 2.0F, 1.0F});
  EXPECT_NEAR(bounds.hi.y, 2.0F, 1e-5F);
  EXPECT_NEAR(bounds.hi.x, 1.0F, 1e-5F);
}

TEST(ShapesTest, TrianglesAreDegenerateWhenTheyHaveNoArea) {
  const auto is_flat = [](const vec3& a, const vec3& b, const vec3& c) {
    Mesh mesh;
    mesh.positions = {a, b, c};
    mesh.triangles = {{0, 1, 2}};
    return world::is_degenerate(mesh, 0);
  };
  EXPECT_FALSE(is_flat({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_TRUE(is_flat({0, 0, 0}, {1, 0, 0}, {1, 0, 0}));
  EXPECT_TRUE(is_flat({1, 2, 3}, {2, 4, 6}, {3, 6, 9}));
  EXPECT_TRUE(is_flat({-1113.5F, 0, 1}, {-1113.25F, 0, 1}, {-1113.0F, 0, 1}));
  EXPECT_FALSE(is_flat({1e5F, 0, 0}, {1e5F + 0.0078125F, 0, 0}, {1e5F, 1e-30F, 0})) << "thin is not flat";
  EXPECT_FALSE(is_flat({0, 0, 0}, {1e-22F, 0, 0}, {0, 1e-22F, 0})) << "tiny is not flat";

  Mesh repeated;
  repeated.positions = {{0, 0, 0}, {1, 0, 0}};
  repeated.triangles = {{0, 1, 1}};
  EXPECT_TRUE(world::is_degenerate(repeated, 0));
}

TEST(ShapesTest, TriangleBoundsHoldTheirCornersExactly) {
  Mesh mesh;
  mesh.positions = {{9, 9, 9}, {0, 2, 0}, {1, 0, -3}, {0.5F, 1, 4}};
  mesh.triangles = {{1, 2, 3}};
  EXPECT_EQ(world::bounds_of_triangle(mesh, 0).lo, vec3(0, 0, -3));
  EXPECT_EQ(world::bounds_of_triangle(mesh, 0).hi, vec3(1, 2, 4));
}

world::Scene world_of(const std::vector<world::Shape>& shapes) {
  world::Scene scene;
  for (const world::Shape& shape : shapes) scene.objects.push_back({"", shape, 0});
  return scene;
}

TEST(SceneTest, BoundsLeaveOutWhatIsInfiniteOrNotDrawn) {
  EXPECT_TRUE(bounds_of(world_of({})).is_empty());
  EXPECT_TRUE(bounds_of(world_of({world::Plane{}, world::NotDrawn{}})).is_empty());
  const Bounds bounds = bounds_of(world_of({world::Plane{}, world::Sphere{vec3(1, 2, 3), 1.0F}}));
  EXPECT_LE(max_abs_component(bounds.center() - vec3(1, 2, 3)), 1e-6F);
}

TEST(SceneTest, PrimitivesAreCounted) {
  Mesh mesh;
  mesh.triangles.resize(3);
  EXPECT_EQ(primitive_count(mesh), 3U);
  EXPECT_EQ(primitive_count(world::Sphere{}), 1U);
  EXPECT_EQ(primitive_count(world::Plane{}), 1U);
  EXPECT_EQ(primitive_count(world::NotDrawn{}), 0U);
}

/// Returns the largest |x| / half width and |y| / half height of a box's corners in the picture; infinite if one lies
/// behind the eye.
dvec2 extent_on_picture(const Camera& camera, const Bounds& box) {
  const dvec3 look(camera.look);
  const dvec3 up(camera.up);
  const dvec3 right = glm::cross(look, up);
  const double tan_y = std::tan(0.5 * camera.yfov);
  dvec2 extent(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p((corner & 1) != 0 ? box.hi.x : box.lo.x, (corner & 2) != 0 ? box.hi.y : box.lo.y,
                  (corner & 4) != 0 ? box.hi.z : box.lo.z);
    const dvec3 v = p - dvec3(camera.eye);
    const double depth = glm::dot(v, look);
    if (depth <= 0.0) return dvec2(std::numeric_limits<double>::infinity());
    extent.x = std::max(extent.x, std::abs(glm::dot(v, right)) / (depth * tan_y * camera.aspect_ratio));
    extent.y = std::max(extent.y, std::abs(glm::dot(v, up)) / (depth * tan_y));
  }
  return extent;
}

TEST(SceneTest, TheCameraInFrontSeesEverything) {
  for (const float aspect_ratio : {0.25F, 1.0F, 16.0F / 9.0F, 5.0F}) {
    for (const float scale : {1e-10F, 1.0F, 1e10F}) {
      for (const vec3& shape : {vec3(1, 1, 1), vec3(10, 1, 1), vec3(1, 10, 1), vec3(1, 1, 10)}) {
        Mesh mesh;
        mesh.positions = {scale * vec3(1, 2, 3), scale * (vec3(1, 2, 3) + shape), scale * vec3(1, 2, 3)};
        mesh.triangles = {{0, 1, 2}};
        const world::Scene scene = world_of({mesh, world::Plane{}});
        const Camera camera = look_from_front(scene, aspect_ratio);
        const dvec2 extent = extent_on_picture(camera, bounds_of(scene));
        EXPECT_LE(std::max(extent.x, extent.y), 1.0) << aspect_ratio << " " << scale;
        EXPECT_GE(std::max(extent.x, extent.y), 0.7) << "too far away";
        EXPECT_GT(camera.eye.y, bounds_of(scene).center().y) << "looks from above";
      }
    }
  }
}

/// Returns the azimuth and elevation in degrees of the camera that frames a box of this size at the origin from three
/// quarters.
dvec2 framed_from(const vec3& size, float aspect_ratio = 1.5F) {
  Scene scene;
  scene.add("box", Box{.half_size = 0.5 * dvec3(size)});
  const Camera camera = frame_scene(scene, aspect_ratio);
  const dvec2 extent = extent_on_picture(camera, bounds_of(scene));
  EXPECT_LE(std::max(extent.x, extent.y), 1.0) << "it does not see all";
  EXPECT_GE(std::max(extent.x, extent.y), 0.6) << "too far away";
  EXPECT_FLOAT_EQ(camera.yfov, glm::radians(40.0F));
  EXPECT_NEAR(glm::dot(camera.look, camera.up), 0.0, 1e-6);
  EXPECT_NEAR(glm::cross(camera.look, camera.up).y, 0.0, 1e-6) << "upright";
  const dvec3 to_eye = -dvec3(camera.look);
  return glm::degrees(dvec2(std::atan2(to_eye.x, to_eye.z), std::asin(to_eye.y)));
}

TEST(SceneTest, ScenesAreFramedFromThreeQuarters) {
  const auto near = [](double azimuth, double elevation) {
    return testing::AllOf(testing::Field(&dvec2::x, testing::DoubleNear(azimuth, 1e-5)),
                          testing::Field(&dvec2::y, testing::DoubleNear(elevation, 1e-5)));
  };
  for (const float scale : {1e-6F, 1.0F, 1e6F}) {
    for (const vec3& size : {vec3(1), vec3(1, 5, 2), vec3(4, 1, 1.01F), vec3(1, 1, 9)}) {
      EXPECT_THAT(framed_from(scale * size), near(30.0, 17.0)) << size.x;
    }
    EXPECT_THAT(framed_from(scale * vec3(4, 1, 0.99F)), near(0.0, 0.0)) << "a board";
    EXPECT_THAT(framed_from(scale * vec3(1, 4, 0.99F)), near(0.0, 0.0)) << "a board that stands";
    EXPECT_THAT(framed_from(scale * vec3(100, 5, 0.1F)), near(0.0, 0.0)) << "a long board";
    EXPECT_THAT(framed_from(scale * vec3(16.1F, 1, 10)), near(30.0, 45.0)) << "a plate";
    EXPECT_THAT(framed_from(scale * vec3(10, 1, 16.1F)), near(30.0, 45.0));
    EXPECT_THAT(framed_from(scale * vec3(15.9F, 1, 10)), near(30.0, 17.0)) << "hardly a plate";
    EXPECT_THAT(framed_from(scale * vec3(100, 0.5F, 5)), near(30.0, 45.0)) << "a strip";
  }
  EXPECT_THAT(framed_from(vec3(1), 0.3F), near(30.0, 17.0));
}

TEST(SceneTest, TheCameraInFrontKeepsItsBits) {
  Mesh mesh;
  mesh.positions = {vec3(-1.0F, 1.5F, 2.0F), vec3(3.0F, 2.5F, 4.0F), vec3(0.0F, 2.0F, 3.0F)};
  mesh.triangles = {{0, 1, 2}};
  const Camera camera = look_from_front(world_of({mesh}), 16.0F / 9.0F);
  EXPECT_EQ(camera.eye, vec3(1.0F, 0x1.8acf12p+1F, 0x1.cfcf4ep+2F));
  EXPECT_EQ(camera.look, vec3(0.0F, -0x1.faaeeep-3F, -0x1.f0154ap-1F));
  EXPECT_EQ(camera.up, vec3(0.0F, 0x1.f0154ap-1F, -0x1.faaeeep-3F));
  for (const float x : {camera.look.x, camera.up.x}) EXPECT_FALSE(std::signbit(x));
  EXPECT_EQ(camera.yfov, 0.7F);
}

TEST(SceneTest, TheCameraInFrontIsUpright) {
  for (const world::Scene& scene :
       {world_of({}), world_of({world::Plane{vec3(0, 5, 0), vec3(0, 1, 0)}}),
        world_of({world::Sphere{vec3(1e7F), 1e-3F}}), world_of({world::Sphere{vec3(0), 1e15F}})}) {
    const Camera camera = look_from_front(scene, 1.5F);
    EXPECT_TRUE(is_finite(camera.eye));
    EXPECT_NEAR(glm::length(camera.look), 1.0, 1e-6);
    EXPECT_NEAR(glm::length(camera.up), 1.0, 1e-6);
    EXPECT_NEAR(glm::dot(camera.look, camera.up), 0.0, 1e-6);
    EXPECT_LT(camera.look.z, -0.9F);
    EXPECT_GT(camera.up.y, 0.9F);
    EXPECT_EQ(camera.near, 0.0F);
    EXPECT_EQ(camera.aspect_ratio, 1.5F);
  }
  EXPECT_GT(look_from_front(world_of({world::Plane{vec3(0, 5, 0), vec3(0, 1, 0)}}), 1.0F).eye.y, 5.0F)
      << "above the ground";
}

TEST(SceneTest, TheHeadlightHasTheThesisPowers) {
  const Light light = make_headlight();
  EXPECT_EQ(light.kind, LightKind::kHeadlight);
  EXPECT_EQ(light.diffuse, vec3(1));
  EXPECT_EQ(light.specular, vec3(1));
  EXPECT_EQ(light.attenuation, Attenuation::kNone);
}

}  // namespace
}  // namespace promin
