// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace promin::oracle {
namespace {

constexpr Real kHitTolerance = 1e-15L;

world::Scene scene_around(std::initializer_list<world::Shape> shapes) {
  world::Scene scene;
  for (const world::Shape& shape : shapes) scene.objects.push_back({"", shape, 0});
  return scene;
}

Hit cast(const world::Shape& shape, const Vector& origin, const Vector& direction) {
  return find_nearest_hit(scene_around({shape}), {origin, direction});
}

void expect_hit(const Hit& hit, Real t, const Vector& normal) {
  ASSERT_TRUE(hit.exists());
  EXPECT_NEAR(hit.t, t, kHitTolerance);
  EXPECT_NEAR(glm::distance(hit.normal, normal), 0, kHitTolerance);
}

/// Expects two numbers that agree to a few roundings of long double.
void expect_near_relative(Real value, Real expected) {
  EXPECT_NEAR(value, expected, 0x1p-62L * expected);
}

Mesh make_right_triangle() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

const world::Cylinder kCylinder{{0, 1, 0}, {0, 1, 0}, 1, 0.5F};
/// The apex is at (0, 2, 0); the base disk has a radius of 1 and lies at y = 0.
const world::Cone kCone{{0, 1, 0}, {0, 1, 0}, 1, 1, 0};
/// The radius is 2 at y = 0, and 1 at y = 2.
const world::Cone kFrustum{{0, 1, 0}, {0, 1, 0}, 1, 2, 1};

TEST(Oracle, Sphere) {
  const world::Sphere sphere{{0, 0, 0}, 2};
  expect_hit(cast(sphere, {0, 0, 5}, {0, 0, -1}), 3, {0, 0, 1});
  expect_hit(cast(sphere, {0, 0, 5}, {0, 0, -2}), 1.5L, {0, 0, 1});
  expect_hit(cast(sphere, {0, 0, 0}, {1, 0, 0}), 2, {1, 0, 0});
  expect_hit(cast(sphere, {1.2L, 0, 5}, {0, 0, -1}), 5 - 1.6L, {0.6L, 0, 0.8L});
  EXPECT_FALSE(cast(sphere, {0, 0, 5}, {0, 0, 1}).exists());
  EXPECT_FALSE(cast(sphere, {2.001L, 0, 5}, {0, 0, -1}).exists());
}

TEST(Oracle, Box) {
  const world::Box box{{1, 0, 0}, {1, 2, 3}, {0, 0, 0}};
  expect_hit(cast(box, {1, 0, 8}, {0, 0, -1}), 5, {0, 0, 1});
  expect_hit(cast(box, {1.5L, 1.5L, 0}, {0, -1, 0}), 3.5L, {0, -1, 0});
  expect_hit(cast(box, {-4, 1, 1}, {2, 0, 0}), 2, {-1, 0, 0});
  EXPECT_FALSE(cast(box, {2.01L, 0, 8}, {0, 0, -1}).exists());
  EXPECT_FALSE(cast(box, {1, 0, 8}, {0, 0, 1}).exists());

  // The rotation is an eighth of a turn about z, given by sin(pi / 8).
  const world::Box turned{{0, 0, 0}, {1, 1, 1}, {0, 0, 0.38268343F}};
  const Real half = std::sqrt(Real(0.5));
  const Hit hit = cast(turned, {4, 0.25L, 0}, {-1, 0, 0});
  EXPECT_NEAR(hit.t, 4 - (2 * half - 0.25L), 1e-7L);
  EXPECT_NEAR(hit.normal.x, half, 1e-7L);
  EXPECT_NEAR(hit.normal.y, half, 1e-7L);
}

TEST(Oracle, Capsule) {
  const world::Capsule pill{{0, 0, 0}, {0, 1, 0}, 2, 1, 1};
  expect_hit(cast(pill, {5, 1, 0}, {-1, 0, 0}), 4, {1, 0, 0});
  expect_hit(cast(pill, {0.6L, 9, 0}, {0, -1, 0}), 6.2L, {0.6L, 0.8L, 0});
  expect_hit(cast(pill, {0, 0, 0}, {0, -1, 0}), 3, {0, -1, 0});
  EXPECT_FALSE(cast(pill, {0.9L, 2.9L, 5}, {0, 0, -1}).exists());
  // The radii are 3 and 0, at a distance of 5, so the sine is 3/5.
  const world::Capsule drop{{0, 0, 0}, {0, 1, 0}, 2.5F, 3, 0};
  expect_hit(cast(drop, {4, 0.5L, 0}, {-1, 0, 0}), 2.5L, {0.8L, 0.6L, 0});
  expect_hit(cast(drop, {0, -8, 0}, {0, 1, 0}), 2.5L, {0, -1, 0});
}

TEST(Oracle, OpenOnesHaveNoDisks) {
  world::Cylinder tube = kCylinder;
  tube.is_open = true;
  expect_hit(cast(tube, {4, 1, 0}, {-1, 0, 0}), 3.5L, {1, 0, 0});
  EXPECT_FALSE(cast(tube, {0.25L, 9, 0}, {0, -1, 0}).exists()) << "along the axis";
  expect_hit(cast(tube, {0, 2.5L, 0}, {1, -2, 0}), 0.5L, {1, 0, 0});
  expect_hit(cast(tube, {0, 1, 0}, {-1, 0, 0}), 0.5L, {-1, 0, 0});
  expect_hit(cast(tube, {4, 2, 0}, {-1, 0, 0}), 3.5L, {1, 0, 0});
  world::Cone cone = kCone;
  cone.is_open = true;
  EXPECT_NEAR(cast(cone, {0.25L, -3, 0}, {0, 1, 0}).t, 4.5L, 1e-15L) << "the wall from inside";
  EXPECT_FALSE(cast(cone, {0.5L, 0.5L, 0}, {0, -1, 0}).exists());
}

TEST(Oracle, PlaneKeepsItsOwnNormal) {
  const world::Plane plane{{0, 1, 0}, {0, 1, 0}};
  expect_hit(cast(plane, {0, 3, 0}, {1, -1, 0}), 2, {0, 1, 0});
  expect_hit(cast(plane, {0, 0, 0}, {0, 2, 0}), 0.5L, {0, 1, 0});
  EXPECT_FALSE(cast(plane, {0, 3, 0}, {1, 0, 0}).exists());
  EXPECT_FALSE(cast(plane, {0, 1, 0}, {1, 0, 0}).exists());
  EXPECT_FALSE(cast(plane, {0, 3, 0}, {0, 1, 0}).exists());
}

TEST(Oracle, SmallSolidsFarAwayKeepTheirShape) {
  // The ray has a chord of 8 around the middle, at a distance of 1e10 sizes: a plain quadratic formula has an error of
  // 50.
  constexpr Real kFar = 1e10L;
  expect_near_relative(cast(world::Sphere{{0, 0, 0}, 5}, {3, 0, kFar}, {0, 0, -1}).t, kFar - 4);
  expect_near_relative(cast(world::Cylinder{{0, 0, 0}, {0, 1, 0}, 1, 5}, {3, 0, kFar}, {0, 0, -1}).t, kFar - 4);
  expect_near_relative(cast(world::Cone{{0, 0, 0}, {0, 1, 0}, 1, 10, 0}, {3, 0, kFar}, {0, 0, -1}).t, kFar - 4);
}

TEST(Oracle, CylinderSideAndDisks) {
  expect_hit(cast(kCylinder, {3, 1, 0}, {-1, 0, 0}), 2.5L, {1, 0, 0});
  expect_hit(cast(kCylinder, {0.3L, 1, 3}, {0, 0, -1}), 2.6L, {0.6L, 0, 0.8L});
  expect_hit(cast(kCylinder, {0.2L, 5, 0}, {0, -1, 0}), 3, {0, 1, 0});
  expect_hit(cast(kCylinder, {0.2L, -5, 0}, {0, 1, 0}), 5, {0, -1, 0});
  expect_hit(cast(kCylinder, {0, 1, 0}, {0, 0, 1}), 0.5L, {0, 0, 1});
  expect_hit(cast(kCylinder, {0, 1, 0}, {0, 1, 0}), 1, {0, 1, 0});
  EXPECT_FALSE(cast(kCylinder, {3, 2.01L, 0}, {-1, 0, 0}).exists());
  EXPECT_FALSE(cast(kCylinder, {0.51L, 5, 0}, {0, -1, 0}).exists());
}

TEST(Oracle, CylinderInAnyDirectionByItsOwnNormalisation) {
  // The axis is (1, 1, 0) / sqrt 2, rounded to fp32, so that its length is not 1.
  const float axis = std::sqrt(0.5F);
  const world::Cylinder leaning{{0, 0, 0}, {axis, axis, 0}, 10, 0.5F};
  const Real root = std::sqrt(Real(2));
  expect_hit(cast(leaning, {2, -2, 0}, {-1, 1, 0}), 2 - 0.5L / root, {1 / root, -1 / root, 0});
  expect_hit(cast(leaning, {0, 3, 0}, {0, -1, 0}), 3 - 0.5L * root, {-1 / root, 1 / root, 0});
}

TEST(Oracle, ConeSideAndBase) {
  const Real root = std::sqrt(Real(5));
  expect_hit(cast(kCone, {3, 1, 0}, {-1, 0, 0}), 2.5L, {2 / root, 1 / root, 0});
  expect_hit(cast(kCone, {0.5L, 5, 0}, {0, -1, 0}), 4, {2 / root, 1 / root, 0});
  expect_hit(cast(kCone, {0.5L, -5, 0}, {0, 1, 0}), 5, {0, -1, 0});
  expect_hit(cast(kCone, {0, 1, 0}, {1, 0, 0}), 0.5L, {2 / root, 1 / root, 0});
  // The other nappe, above the apex, does not belong to the cone.
  EXPECT_FALSE(cast(kCone, {3, 3, 0}, {-1, 0, 0}).exists());
  EXPECT_FALSE(cast(kCone, {1.01L, 5, 0}, {0, -1, 0}).exists());
}

TEST(Oracle, ConeParallelToAGenerator) {
  // Along the generator x = 1 - y / 2 the quadratic term vanishes, and one hit remains on the opposite side.
  const Vector along(1, -2, 0);
  const Vector normal = Vector(-2, 1, 0) / std::sqrt(Real(5));
  expect_hit(cast(kCone, {-2, 3, 0}, along), 1.25L, normal);
  expect_hit(cast(kCone, {-1, 3, 0}, along), 0.75L, normal);
  // The ray would hit the opposite side on the other nappe.
  EXPECT_FALSE(cast(kCone, {0, 3, 0}, along).exists());
}

TEST(Oracle, FrustumSideAndDisks) {
  const Real root = std::sqrt(Real(5));
  expect_hit(cast(kFrustum, {3, 1, 0}, {-1, 0, 0}), 1.5L, {2 / root, 1 / root, 0});
  expect_hit(cast(kFrustum, {0.9L, 5, 0}, {0, -1, 0}), 3, {0, 1, 0});
  expect_hit(cast(kFrustum, {1.5L, 5, 0}, {0, -1, 0}), 4, {2 / root, 1 / root, 0});
  expect_hit(cast(kFrustum, {1.5L, -5, 0}, {0, 1, 0}), 5, {0, -1, 0});
  const world::Cone upside_down{{0, 1, 0}, {0, -1, 0}, 1, 1, 2};
  expect_hit(cast(upside_down, {1.5L, 5, 0}, {0, -1, 0}), 4, {2 / root, 1 / root, 0});
}

TEST(Oracle, Triangle) {
  const Hit hit = cast(make_right_triangle(), {0.5L, 1, 3}, {0, 0, -1});
  expect_hit(hit, 3, {0, 0, 1});
  EXPECT_NEAR(hit.u, 0.25L, kHitTolerance);
  EXPECT_NEAR(hit.v, 0.25L, kHitTolerance);
  expect_hit(cast(make_right_triangle(), {0.5L, 1, -3}, {0, 0, 1}), 3, {0, 0, 1});
  expect_hit(cast(make_right_triangle(), {1, 2, 3}, {0, 0, -1}), 3, {0, 0, 1});
  expect_hit(cast(make_right_triangle(), {0, 0, 3}, {0, 0, -1}), 3, {0, 0, 1});
  EXPECT_FALSE(cast(make_right_triangle(), {1.001L, 2, 3}, {0, 0, -1}).exists());
  EXPECT_FALSE(cast(make_right_triangle(), {-0.001L, 1, 3}, {0, 0, -1}).exists());
  EXPECT_FALSE(cast(make_right_triangle(), {-1, 1, 0}, {1, 0, 0}).exists());
}

TEST(Oracle, DegenerateTrianglesKeepTheirNumberAndAreNotHit) {
  Mesh mesh = make_right_triangle();
  mesh.triangles = {{0, 1, 1}, {0, 1, 2}};
  EXPECT_EQ(cast(mesh, {0.5L, 1, 3}, {0, 0, -1}).primitive, 1);
  mesh.triangles = {{0, 1, 1}};
  EXPECT_FALSE(cast(mesh, {0.5L, 0, 3}, {0, 0, -1}).exists());
}

TEST(Oracle, TheIntervalIsOpen) {
  const world::Scene scene = scene_around({world::Plane{{0, 0, 0}, {0, 1, 0}}});
  const auto exists = [&](Real tmin, Real tmax) { return is_occluded(scene, {{0, 2, 0}, {0, -1, 0}, tmin, tmax}); };
  EXPECT_TRUE(exists(0, kInfinity));
  EXPECT_TRUE(exists(-5, 2.5L));
  EXPECT_TRUE(exists(1.99L, 2.01L));
  EXPECT_FALSE(exists(2, kInfinity));
  EXPECT_FALSE(exists(0, 2));
  EXPECT_FALSE(exists(3, 1));
  // A negative tmin counts as 0.
  EXPECT_FALSE(is_occluded(scene, {{0, -2, 0}, {0, -1, 0}, -5, kInfinity}));
}

TEST(Oracle, TheNearestAndOfEqualOnesTheFirstIsFound) {
  const world::Sphere sphere{{0, 0, 0}, 1};
  const world::Scene scene = scene_around({world::NotDrawn{}, world::Sphere{{0, 0, -5}, 1}, sphere, sphere});
  EXPECT_EQ(find_nearest_hit(scene, {{0, 0, 5}, {0, 0, -1}}).object, 2);
  EXPECT_EQ(find_nearest_hit(scene, {{0, 0, -9}, {0, 0, 1}}).object, 1);
  Mesh twice = make_right_triangle();
  twice.triangles.push_back(twice.triangles.front());
  EXPECT_EQ(cast(twice, {0.5L, 1, 3}, {0, 0, -1}).primitive, 0);
}

TEST(Oracle, RaysWithoutMeaningMiss) {
  const world::Scene scene = scene_around({world::Sphere{{0, 0, 0}, 1}});
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  const Vector origin(0, 0, 5);
  const Vector direction(0, 0, -1);
  EXPECT_TRUE(is_occluded(scene, {origin, direction}));
  for (const Ray& ray :
       {Ray{{nan, 0, 5}, direction}, Ray{{0, 0, kInfinity}, direction}, Ray{origin, {0, 0, 0}},
        Ray{origin, {0, nan, -1}}, Ray{origin, {0, 0, -kInfinity}}, Ray{origin, direction, nan},
        Ray{origin, direction, 0, nan}, Ray{origin, direction, kInfinity}, Ray{origin, direction, 0, -kInfinity}}) {
    EXPECT_FALSE(is_occluded(scene, ray));
  }
}

/// Returns the distance of a point from the surface of a solid of revolution along +Y from y = 0 to 2. It uses only the
/// distances to the segments of the profile (radius, height).
Real distance_to_profile(const Vector& p, Real bottom, Real top) {
  const glm::vec<2, Real> q(std::hypot(p.x, p.z), p.y);
  const glm::vec<2, Real> profile[] = {{0, 0}, {bottom, 0}, {top, 2}, {0, 2}};
  Real least = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const auto edge = profile[i + 1] - profile[i];
    const Real length2 = glm::dot(edge, edge);
    const Real s = length2 > 0 ? std::clamp(glm::dot(q - profile[i], edge) / length2, Real(0), Real(1)) : Real(0);
    least = std::min(least, glm::distance(q, profile[i] + s * edge));
  }
  return least;
}

TEST(Oracle, HitsLieOnTheSurfaceAndRaysTowardsTheInsideHit) {
  std::mt19937 random(1);
  const auto number = [&] { return static_cast<Real>(random()) * 0x1p-31L - 1; };
  const struct {
    world::Shape shape;
    Real bottom;
    Real top;
  } solids[] = {{kCylinder, 0.5L, 0.5L}, {kCone, 1, 0}, {kFrustum, 2, 1}};
  for (const auto& [shape, bottom, top] : solids) {
    for (int i = 0; i < 2000; ++i) {
      const Vector inside(0.1L * number(), 1 + 0.5L * number(), 0.1L * number());
      const Vector away(number(), number(), number());
      const Vector origin = inside + Real(10) * glm::normalize(away);
      const Hit hit = cast(shape, origin, inside - origin);
      ASSERT_TRUE(hit.exists());
      ASSERT_LT(hit.t, 1);
      ASSERT_LE(glm::dot(hit.normal, inside - origin), 0);
      ASSERT_LE(distance_to_profile(origin + hit.t * (inside - origin), bottom, top), kHitTolerance);
    }
  }
}

}  // namespace
}  // namespace promin::oracle
