// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/verdict.h"

#include <gtest/gtest.h>

#include <cmath>

namespace promin::oracle {
namespace {

constexpr Real kU = kRoundoff;
const Vector kDown(0, 0, -1);
const Answer kMiss;

world::Scene world_with(std::initializer_list<world::Shape> shapes) {
  world::Scene scene;
  for (const world::Shape& shape : shapes) scene.objects.push_back({"", shape, 0});
  return scene;
}

/// Expects a margin. Margins come from a search that is exact to 1e-9, and the expected numbers leave out terms of
/// second order.
void expect_margin(const Verdict& verdict, Real expected) {
  EXPECT_FALSE(verdict.is_same);
  EXPECT_NEAR(verdict.margin, expected, 1e-5L * expected);
}

const world::Scene kSphere = world_with({world::Sphere{{0, 0, 0}, 1}});
const world::Scene kTriangle = [] {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 1}};
  return world_with({mesh});
}();
/// The can reaches from y = -2 to 2.
const world::Scene kCan = world_with({world::Cylinder{{0, 0, 0}, {0, 1, 0}, 2, 1}});

TEST(Verdict, TheExactAnswerIsTheSame) {
  const Verdict verdict = judge(kSphere, {{0, 0, 5}, kDown}, {4, 0, 0});
  EXPECT_TRUE(verdict.is_same);
  EXPECT_EQ(verdict.exact.t, 4);
  EXPECT_EQ(verdict.t_error, 0);
  EXPECT_EQ(verdict.surface_error, 0);
  EXPECT_EQ(verdict.margin, 0);
  EXPECT_TRUE(judge(kSphere, {{3, 0, 5}, kDown}, kMiss).is_same);
  EXPECT_TRUE(judge(kSphere, {{0, 0, 5}, {0, 0, 0}}, kMiss).is_same);
}

TEST(Verdict, DisksThatAreMissingHideNothing) {
  // The tube reaches from y = -2 to 2.
  const world::Scene tube = world_with({world::Cylinder{{0, 0, 0}, {0, 1, 0}, 2, 1, true}});
  const Ray through{{0.5L, 9, 0}, {0, -1, 0}};
  EXPECT_TRUE(judge(tube, through, kMiss).is_same);
  EXPECT_GT(judge(tube, through, {7, 0, 0}).margin, 1e5L) << "a hit of the disk";
  const Ray onto_wall{{0, 3, 0}, {1, -2, 0}};
  EXPECT_TRUE(judge(tube, onto_wall, {1, 0, 0}).is_same);
  EXPECT_GT(judge(tube, onto_wall, kMiss).margin, 1e5L);
  // The ray passes over the rim at 3 u S.
  const Real scale = std::sqrt(Real(29)) + std::sqrt(Real(5));
  const Ray over_rim{{5, 2 + 3 * kU * scale, 0}, {-1, 0, 0}};
  EXPECT_TRUE(judge(tube, over_rim, kMiss).is_same);
  const Verdict onto_rim = judge(tube, over_rim, {4, 0, 0});
  EXPECT_FALSE(onto_rim.is_same);
  EXPECT_NEAR(onto_rim.margin, 3, 0.1L);
}

TEST(Verdict, ErrorsOfTCountByTheAngleAndTheScale) {
  // The ray hits the sphere at (0.6, 0, 0.8) with a cosine of 0.8, at t = 4.2; the direction of length 2 halves t.
  const Ray ray{{0.6L, 0, 5}, {0, 0, -2}};
  const Real scale = std::hypot(Real(5), 0.6L) + 1;
  for (const Real units : {3.0L, 7.0L, 100.0L}) {
    const Verdict verdict = judge(kSphere, ray, {2.1L - units * kU * scale / 1.6L, 0, 0});
    EXPECT_TRUE(verdict.is_same);
    EXPECT_NEAR(verdict.t_error, units, 1e-4L * units);
    EXPECT_NEAR(verdict.surface_error, units, 1e-4L * units);
    EXPECT_EQ(verdict.margin, 0);
  }
}

TEST(Verdict, PlanesCountTheLengthOfTheRay) {
  // The ray starts 1 above the plane, and hits it at a distance of 1000 with a cosine of 1e-3.
  const world::Scene scene = world_with({world::Plane{{0, 0, 0}, {0, 0, 1}}});
  const Ray ray{{0, 0, 1}, {1000, 0, -1}};
  const Verdict verdict = judge(scene, ray, {1 + 5 * kU * 1001, 0, 0});
  EXPECT_TRUE(verdict.is_same);
  EXPECT_NEAR(verdict.t_error, 5, 1e-4L);
  EXPECT_NEAR(verdict.surface_error, 5, 0.01L);
}

TEST(Verdict, ASilhouetteExplainsHitsAndMissesBesideIt) {
  const Real scale = std::hypot(Real(1), Real(5)) + 1;
  for (const Real units : {0.5L, 1.5L, 20.0L}) {
    const Real offset = units * kU * scale;
    expect_margin(judge(kSphere, {{1 + offset, 0, 5}, kDown}, {5, 0, 0}), units);
    expect_margin(judge(kSphere, {{1 - offset, 0, 5}, kDown}, kMiss), units);
    EXPECT_NEAR(judge(kSphere, {{1 + offset, 0, 5}, kDown}, {5, 0, 0}).surface_error, units, 1e-5L * units);
  }
}

TEST(Verdict, AMissingSphereIsNotExcused) {
  expect_margin(judge(kSphere, {{0, 0, 5}, kDown}, kMiss), 1 / (6 * kU));
  expect_margin(judge(kSphere, {{1.5L, 0, 5}, kDown}, {5, 0, 0}), 0.5L / (kU * (std::hypot(1.5L, Real(5)) + 1)));
}

TEST(Verdict, LeavingASolidIsNotEnteringIt) {
  expect_margin(judge(kSphere, {{0, 0, 5}, kDown}, {6, 0, 0}), 1 / (6 * kU));
  EXPECT_GT(judge(kSphere, {{0, 0, 0}, kDown}, {-1, 0, 0}).margin, 1000);
  // If the ray starts within a unit above or below the surface, both the entry and the exit are correct answers.
  const Real unit = kU * 2;
  expect_margin(judge(kSphere, {{0, 0, 1 + unit}, kDown}, {2, 0, 0}), 1);
  expect_margin(judge(kSphere, {{0, 0, 1 - unit}, kDown}, {unit, 0, 0}), 1);
}

TEST(Verdict, TheIntervalsEndsExplainWhatIsNearThem) {
  const Real unit = 6 * kU;
  const auto ray = [](Real tmin, Real tmax) { return Ray{{0, 0, 5}, kDown, tmin, tmax}; };
  expect_margin(judge(kSphere, ray(4 + 1.5L * unit, kInfinity), {4, 0, 0}), 1.5L);
  expect_margin(judge(kSphere, ray(4 - 1.5L * unit, kInfinity), {6, 0, 0}), 1.5L);
  expect_margin(judge(kSphere, ray(0, 4 + 1.5L * unit), kMiss), 1.5L);
  expect_margin(judge(kSphere, ray(0, 4 - 1.5L * unit), {4, 0, 0}), 1.5L);
  expect_margin(judge(kSphere, ray(0, 3), {4, 0, 0}), 1 / unit);
  expect_margin(judge(kSphere, ray(5, kInfinity), kMiss), 1 / unit);
  EXPECT_EQ(judge(kSphere, ray(5, 3), {4, 0, 0}).margin, kInfinity);
}

TEST(Verdict, EdgesExplainHitsAndMissesBesideThem) {
  const Real scale = std::sqrt(Real(9) + 1) + std::sqrt(Real(5));
  const Real offset = 1.5L * kU * scale;
  expect_margin(judge(kTriangle, {{1, -offset, 3}, kDown}, {3, 0, 0}), 1.5L);
  expect_margin(judge(kTriangle, {{1, offset, 3}, kDown}, kMiss), 1.5L);
  EXPECT_GT(judge(kTriangle, {{1, -0.001L, 3}, kDown}, {3, 0, 0}).margin, 1000);
  EXPECT_GT(judge(kTriangle, {{1, 0.001L, 3}, kDown}, kMiss).margin, 1000);
  EXPECT_GT(judge(kTriangle, {{-1, 1, 0}, {1, 0, 1e-3L}}, {1, 0, 0}).margin, 1000);
  // A ray in the plane of the triangle may hit or miss it.
  EXPECT_EQ(judge(kTriangle, {{-1, 1, 0}, {1, 0, 0}}, {2, 0, 0}).margin, 0);
  EXPECT_GT(judge(kTriangle, {{-1, 1, 0}, {1, 0, 0}}, {9, 0, 0}).margin, 1000) << "beyond its corners";
}

TEST(Verdict, RimsExplainHitsAndMissesBesideThem) {
  const Real scale = 5 + std::sqrt(Real(5));
  const Real offset = 1.5L * kU * scale;
  const Real root = std::sqrt(Real(2));
  // The ray passes over the rim at (0, 2, 1), falling by 45 degrees.
  const auto past_rim = [&](Real x) { return Ray{Vector(0, 5, -2) + x * Vector(0, 1, 1) / root, {0, -1, 1}}; };
  const Real rim_scale = std::sqrt(Real(29)) + std::sqrt(Real(5));
  expect_margin(judge(kCan, past_rim(1.5L * kU * rim_scale), {3, 0, 0}), 1.5L);
  expect_margin(judge(kCan, {{0, 5, 1 - offset}, {0, -1, 0}}, kMiss),
                1.5L * scale / (std::sqrt(Real(26)) + std::sqrt(Real(5))));
  EXPECT_GT(judge(kCan, past_rim(1e-3L), {3, 0, 0}).margin, 1000);
  EXPECT_GT(judge(kCan, past_rim(-1e-3L), kMiss).margin, 1000);
}

TEST(Verdict, ConesHaveAnApex) {
  const world::Scene scene = world_with({world::Cone{{0, 0, 0}, {0, 1, 0}, 1, 1, 0}});
  const Real scale = std::hypot(Real(1), Real(5)) + std::sqrt(Real(2));
  expect_margin(judge(scene, {{0, 1 + 1.5L * kU * scale, 5}, kDown}, {5, 0, 0}), 1.5L);
  EXPECT_GT(judge(scene, {{0, 1.5L, 5}, kDown}, {5, 0, 0}).margin, 1000) << "the mirror nappe";
}

TEST(Verdict, SurfacesCloserThanRoundingMaySwap) {
  // S = 5 + |t d| is 10 for both.
  for (const Real units : {1.0L, 1.5L, 50.0L}) {
    const auto below = static_cast<float>(units * 20 * kU);
    const world::Scene planes =
        world_with({world::Plane{{0, 0, 0}, {0, 0, 1}}, world::Plane{{0, 0, -below}, {0, 0, 1}}});
    expect_margin(judge(planes, {{0, 0, 5}, kDown}, {5 + Real(below), 1, 0}), units);
  }
  const world::Scene spheres = world_with({world::Sphere{{0, 0, 0}, 1}, world::Sphere{{0, 0, -1}, 1}});
  expect_margin(judge(spheres, {{0, 0, 5}, kDown}, {5, 1, 0}), 1 / ((6 + 7) * kU));
}

TEST(Verdict, TheSamePlaceOnAnotherPrimitiveIsExcusedButNotAnyPlace) {
  Mesh twice = std::get<Mesh>(kTriangle.objects[0].shape);
  twice.triangles[1] = twice.triangles[0];
  const Ray ray{{1, 1, 3}, kDown};
  expect_margin(judge(world_with({twice}), ray, {3, 0, 1}), 0);
  EXPECT_GT(judge(world_with({twice}), ray, {2, 0, 1}).margin, 1000);
  EXPECT_GT(judge(world_with({twice}), ray, {4, 0, 1}).margin, 1000);
  const world::Scene spheres = world_with({world::Sphere{{0, 0, 0}, 1}, world::Sphere{{0, 0, 0}, 1}});
  expect_margin(judge(spheres, {{0, 0, 5}, kDown}, {4, 1, 0}), 0);
  EXPECT_GT(judge(spheres, {{0, 0, 5}, kDown}, {3.9L, 1, 0}).margin, 1000);
}

TEST(Verdict, AllThatLiesInFrontNeedsAnExcuse) {
  // The ray passes near the silhouette of the exact hit; the second sphere is in full view.
  const Real offset = 0.5L * kU * (std::hypot(Real(1), Real(5)) + 1);
  const world::Scene two = world_with({world::Sphere{{0, 0, 0}, 1}, world::Sphere{{1, 0, -9}, 1}});
  const world::Scene three =
      world_with({world::Sphere{{0, 0, 0}, 1}, world::Sphere{{1, 0, -9}, 1}, world::Sphere{{1, 0, -5}, 1}});
  expect_margin(judge(two, {{1 - offset, 0, 5}, kDown}, {13, 1, 0}), 0.5L);
  EXPECT_GT(judge(three, {{1 - offset, 0, 5}, kDown}, {13, 1, 0}).margin, 1000);
}

TEST(Verdict, PlanesAreMissedOnlyByRaysAlongThem) {
  const world::Scene scene = world_with({world::Plane{{0, 0, 0}, {0, 0, 1}}});
  expect_margin(judge(scene, {{0, 0, 1}, {1, 0, -1.5L * kU}}, kMiss), 1.5L);
  expect_margin(judge(scene, {{0, 0, 1}, {1, 0, 1.5L * kU}}, {1e12L, 0, 0}), 1.5L);
  EXPECT_GT(judge(scene, {{0, 0, 1}, {1, 0, -1e-3L}}, kMiss).margin, 1000);
  EXPECT_GT(judge(scene, {{0, 0, 1}, {1, 0, 1e-3L}}, {1e12L, 0, 0}).margin, 1000);
  EXPECT_GT(judge(scene, {{0, 0, 1}, {0, 0, 1}}, {1, 0, 0}).margin, 1000) << "behind the origin";
}

TEST(Verdict, NothingExplainsWhatDoesNotExist) {
  const Ray ray{{0, 0, 5}, kDown};
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  const world::Scene scene = world_with({world::Sphere{{0, 0, 0}, 1}, world::NotDrawn{}});
  for (const Answer& answer : {Answer{4, 2, 0}, Answer{4, 1, 0}, Answer{4, 0, 1}, Answer{4, 0, -1}, Answer{4, -2, 0},
                               Answer{nan, 0, 0}, Answer{kInfinity, 0, 0}}) {
    const Verdict verdict = judge(scene, ray, answer);
    EXPECT_FALSE(verdict.is_same);
    EXPECT_EQ(verdict.margin, kInfinity);
    EXPECT_EQ(verdict.t_error, kInfinity);
    EXPECT_EQ(verdict.surface_error, kInfinity);
  }
  EXPECT_EQ(judge(scene, {{0, 0, 5}, {0, 0, 0}}, {4, 0, 0}).margin, kInfinity);
  EXPECT_EQ(judge(scene, {{0, 0, 5}, kDown, nan}, {4, 0, 0}).margin, kInfinity);
  EXPECT_EQ(judge(kTriangle, {{1, 0, 5}, kDown}, {5, 0, 1}).margin, kInfinity) << "degenerate";
}

TEST(Verdict, ScalesAndDistancesOfAllSizes) {
  for (const Real size : {1e-3L, 1.0L, 1e6L}) {
    for (const Real far : {0.0L, 1e5L}) {
      const Vector center(vec3(far, -far, far));
      const world::Scene scene = world_with({world::Sphere{vec3(center), static_cast<float>(size)}});
      const Real r = static_cast<float>(size);
      const Real scale = std::hypot(r, 5 * r) + r;
      const Vector origin = center + Vector(r + 1.5L * kU * scale, 0, 5 * r);
      expect_margin(judge(scene, {origin, kDown}, {5 * r, 0, 0}), 1.5L);
      EXPECT_LT(judge(scene, {center + Vector(0, 0, 5 * r), kDown}, {4 * r, 0, 0}).t_error, 1e-3L);
    }
  }
}

}  // namespace
}  // namespace promin::oracle
