// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/distance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace promin::oracle {
namespace {

constexpr Real kTolerance = 1e-15L;

Mesh make_triangle() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 1}};
  return mesh;
}

TEST(Distance, FromTheInsideItIsNegative) {
  EXPECT_NEAR(signed_distance(world::Sphere{{1, 0, 0}, 2}, 0, {1, 5, 0}), 3, kTolerance);
  EXPECT_NEAR(signed_distance(world::Sphere{{1, 0, 0}, 2}, 0, {1, 0.5L, 0}), -1.5L, kTolerance);
  EXPECT_NEAR(signed_distance(world::Plane{{0, 1, 0}, {0, 2, 0}}, 0, {7, -2, 0}), 3, kTolerance);
  const world::Cylinder can{{0, 0, 0}, {0, 1, 0}, 2, 1};
  EXPECT_NEAR(signed_distance(can, 0, {0.25L, 0, 0}), -0.75L, kTolerance);
  EXPECT_NEAR(signed_distance(can, 0, {0.25L, 1.5L, 0}), -0.5L, kTolerance);
  EXPECT_NEAR(signed_distance(can, 0, {0, 0, 3}), 2, kTolerance);
  EXPECT_NEAR(signed_distance(can, 0, {0.5L, 3, 0}), 1, kTolerance);
  EXPECT_NEAR(signed_distance(can, 0, {4, 6, 0}), 5, kTolerance) << "to the rim, 3 and 4 away";
}

TEST(Distance, OpenOnesHaveTheirSideAlone) {
  world::Cylinder tube{{0, 0, 0}, {0, 1, 0}, 2, 1};
  EXPECT_NEAR(surface_distance(tube, 0, {0, 1.5L, 0}), 0.5L, kTolerance);
  EXPECT_FALSE(place_in_open(tube, {0, 0, 0}).has_value());
  tube.is_open = true;
  EXPECT_NEAR(surface_distance(tube, 0, {0, 1.5L, 0}), 1, kTolerance);
  EXPECT_NEAR(surface_distance(tube, 0, {4, 6, 0}), 5, kTolerance) << "to the rim, 3 and 4 away";
  EXPECT_NEAR(surface_distance(tube, 0, {0, 2, 0}), 1, kTolerance) << "where a disk would be";
  const auto place = place_in_open(tube, {0.25L, 3, 0});
  ASSERT_TRUE(place.has_value());
  EXPECT_NEAR(place->beyond_side, -0.75L, kTolerance);
  EXPECT_NEAR(place->beyond_ends, 1, kTolerance);
}

TEST(Distance, ConesHaveASlope) {
  // The apex is at (0, 1, 0); the side falls by one in height for each two across.
  const world::Cone cone{{0, 0, 0}, {0, 1, 0}, 1, 4, 0};
  const Real root = std::sqrt(Real(5));
  EXPECT_NEAR(signed_distance(cone, 0, {0, 0, 0}), -2 / root, kTolerance);
  EXPECT_NEAR(signed_distance(cone, 0, {2, 0, 0}), 0, kTolerance);
  EXPECT_NEAR(signed_distance(cone, 0, Vector(3, 2, 0)), 5 / root, kTolerance);
  EXPECT_NEAR(signed_distance(cone, 0, {0, 3, 0}), 2, kTolerance) << "to the apex";
  EXPECT_NEAR(signed_distance(cone, 0, {2, -3, 0}), 2, kTolerance);
}

TEST(Distance, BoxesHaveFacesEdgesAndCorners) {
  const world::Box box{{1, 0, 0}, {1, 2, 3}, {0, 0, 0}};
  EXPECT_NEAR(signed_distance(box, 0, {1, 0, 0}), -1, kTolerance);
  EXPECT_NEAR(signed_distance(box, 0, {1, 1.5L, 0}), -0.5L, kTolerance);
  EXPECT_NEAR(signed_distance(box, 0, {1, -4, 0}), 2, kTolerance);
  EXPECT_NEAR(signed_distance(box, 0, {5, 6, 0}), 5, kTolerance) << "to an edge, 3 and 4 away";
  EXPECT_NEAR(signed_distance(box, 0, {4, 4, 4}), 3, kTolerance) << "to a corner, 2, 2 and 1 away";
  EXPECT_NEAR(distance_to_crease(box, {5, 6, 0}), 5, kTolerance);
  EXPECT_NEAR(distance_to_crease(box, {1, 2, 0.5L}), 1, kTolerance) << "in a face";
  EXPECT_NEAR(distance_to_crease(box, {4, 4, 4}), 3, kTolerance);
}

TEST(Distance, CapsulesAreTheHullOfTwoSpheres) {
  const world::Capsule pill{{0, 0, 0}, {0, 1, 0}, 2, 1, 1};
  EXPECT_NEAR(signed_distance(pill, 0, {0, 0, 0}), -1, kTolerance);
  EXPECT_NEAR(signed_distance(pill, 0, {4, 1, 0}), 3, kTolerance);
  EXPECT_NEAR(signed_distance(pill, 0, {3, 6, 0}), 4, kTolerance) << "to the upper end, 3 and 4 away";
  // The radii are 3 and 0, at a distance of 5, so the sine is 3/5.
  const world::Capsule drop{{0, 0, 0}, {0, 1, 0}, 2.5F, 3, 0};
  EXPECT_NEAR(signed_distance(drop, 0, {0, 2.5L, 0}), 0, kTolerance) << "the point";
  EXPECT_NEAR(signed_distance(drop, 0, {0, 6.5L, 0}), 4, kTolerance);
  EXPECT_NEAR(signed_distance(drop, 0, {0, 0, 0}), 2.5L * 0.6L - 3, kTolerance) << "to the cone";
  EXPECT_NEAR(signed_distance(drop, 0, {0, -7.5L, 0}), 2, kTolerance);
  const world::Capsule held{{0, 0, 0}, {0, 1, 0}, 0.5F, 3, 1};
  EXPECT_NEAR(signed_distance(held, 0, {0, 6.5L, 0}), 4, kTolerance) << "of the larger sphere alone";
}

TEST(Distance, TrianglesHaveFacesEdgesAndCorners) {
  const Mesh mesh = make_triangle();
  EXPECT_NEAR(signed_distance(mesh, 0, {1, 1, -2}), 2, kTolerance);
  EXPECT_NEAR(signed_distance(mesh, 0, {1, -3, 4}), 5, kTolerance);
  EXPECT_NEAR(signed_distance(mesh, 0, {3, 3, 0}), 3 / std::sqrt(Real(2)), kTolerance);
  EXPECT_NEAR(signed_distance(mesh, 0, {6, -4, 0}), 5, kTolerance);
}

TEST(Distance, CreasesAreRimsAndApices) {
  const world::Cone cone{{0, 0, 0}, {0, 2, 0}, 1, 4, 0};
  EXPECT_NEAR(distance_to_crease(cone, {0, 3, 0}), 2, kTolerance);
  EXPECT_NEAR(distance_to_crease(cone, {0, -5, 7}), 5, kTolerance);
  EXPECT_NEAR(distance_to_crease(world::Cylinder{{0, 0, 0}, {0, 1, 0}, 2, 1}, {0.5L, 2, 0}), 0.5L, kTolerance);
  EXPECT_EQ(distance_to_crease(world::Sphere{}, {0, 0, 0}), kInfinity);
}

TEST(Distance, TheScaleIsDistanceAndSize) {
  const Ray ray{{0, 3, 4}, {0, 0, 1}};
  EXPECT_NEAR(scale_of(world::Sphere{{0, 0, 0}, 2}, 0, ray), 7, kTolerance);
  EXPECT_NEAR(scale_of(world::Plane{{0, 0, 0}, {0, 1, 0}}, 0, ray), 5, kTolerance);
  EXPECT_NEAR(scale_of(world::Cylinder{{0, 0, 0}, {0, 1, 0}, 4, 3}, 0, ray), 10, kTolerance);
  EXPECT_NEAR(scale_of(world::Cone{{0, 0, 0}, {0, 1, 0}, 4, 1, 3}, 0, ray), 10, kTolerance);
  EXPECT_NEAR(scale_of(make_triangle(), 0, {{1, 1, 5}, {0, 0, 1}}), 5 + std::sqrt(Real(5)), kTolerance);
}

TEST(Distance, OnlyWhatCanBeHitIsHittable) {
  EXPECT_TRUE(is_hittable(world::Sphere{}, 0));
  EXPECT_FALSE(is_hittable(world::Sphere{}, 1));
  EXPECT_FALSE(is_hittable(world::Sphere{}, -1));
  EXPECT_FALSE(is_hittable(world::NotDrawn{}, 0));
  EXPECT_TRUE(is_hittable(make_triangle(), 0));
  EXPECT_FALSE(is_hittable(make_triangle(), 1)) << "degenerate";
  EXPECT_FALSE(is_hittable(make_triangle(), 2));
}

}  // namespace
}  // namespace promin::oracle
