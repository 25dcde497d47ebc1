// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check how much the results of two devices for one piece of a job may differ.
#include "work/jobs/compare_pieces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "promin/error.h"

namespace promin::work {
namespace {

PicturePart make_part() {
  PicturePart part;
  part.image.size = uvec2(40, 25);
  part.image.pixels.assign(1000, vec3(0.5F));
  part.channels = {{"Z", false, std::vector(1000, std::bit_cast<uint32_t>(20.0F))},
                   {"object", true, std::vector<uint32_t>(1000, 3)}};
  return part;
}

TEST(ComparePartsTest, NumbersMayDifferByLittle) {
  PicturePart anew = make_part();
  anew.image.pixels[7].y += 0.0039F;
  anew.image.pixels[8] = vec3(0.501F, 0.5F, 0.498F);
  // Above 1, differences are relative to the number.
  anew.channels[0].values[9] = std::bit_cast<uint32_t>(20.07F);
  const PieceDifference difference = compare_parts(make_part(), anew, "a.piece");
  EXPECT_EQ(difference.count, 1000U);
  EXPECT_EQ(difference.mismatches, 0U);
  EXPECT_NEAR(difference.largest, 0.0039, 1e-6);
  EXPECT_TRUE(difference.is_within_bounds());
}

TEST(ComparePartsTest, AnEdgeMayDecideForFewPixels) {
  PicturePart anew = make_part();
  anew.image.pixels[1].x += 0.0041F;
  anew.channels[0].values[2] = std::bit_cast<uint32_t>(20.09F);
  anew.channels[0].values[3] = std::bit_cast<uint32_t>(std::numeric_limits<float>::infinity());
  anew.channels[1].values[4] = 2;
  anew.image.pixels[5].z = std::numeric_limits<float>::quiet_NaN();
  PieceDifference difference = compare_parts(make_part(), anew, "a.piece");
  EXPECT_EQ(difference.mismatches, 5U);
  EXPECT_EQ(difference.largest, 0.0);
  EXPECT_TRUE(difference.is_within_bounds());
  anew.image.pixels[6].x = 0.0F;
  difference = compare_parts(make_part(), anew, "a.piece");
  EXPECT_EQ(difference.mismatches, 6U);
  EXPECT_FALSE(difference.is_within_bounds());
}

TEST(ComparePartsTest, WhatIsNoNumberInBothIsTheSame) {
  PicturePart there = make_part();
  there.image.pixels[0] = vec3(std::numeric_limits<float>::quiet_NaN());
  there.channels[0].values.assign(1000, std::bit_cast<uint32_t>(std::numeric_limits<float>::infinity()));
  PicturePart anew = there;
  anew.image.pixels[0] = vec3(-std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(compare_parts(there, anew, "a.piece").mismatches, 0U);
}

TEST(ComparePartsTest, PartsOfOtherPicturesAreRefused) {
  PicturePart anew = make_part();
  anew.channels[1].name = "primitive";
  EXPECT_THROW(compare_parts(make_part(), anew, "a.piece"), InputError);
  anew = make_part();
  anew.image.size = uvec2(25, 40);
  EXPECT_THROW(compare_parts(make_part(), anew, "a.piece"), InputError);
}

/// Returns a ball of radius 1 at a distance of 10 from the origins of the rays, and a plane behind it.
Scene make_scene() {
  Scene scene;
  scene.materials.resize(1);
  scene.add("ball", Sphere{dvec3(0, 0, -10), 1.0});
  scene.add("floor", Plane{});
  return scene;
}

Ray make_ray() {
  Ray ray;
  ray.direction = vec3(0, 0, -2);
  return ray;
}

Hit make_hit(int32_t object, float t) {
  Hit hit;
  hit.object = object;
  hit.primitive = 0;
  hit.t = t;
  hit.normal = vec3(0, 0, 1);
  return hit;
}

PieceDifference compare_one(const Hit& there, const Hit& anew) {
  const Ray ray = make_ray();
  HitComparison comparison(make_scene());
  comparison.compare({&ray, 1}, {&there, 1}, {&anew, 1});
  return comparison.difference();
}

TEST(HitComparisonTest, TMayDifferByTwiceItsBound) {
  // The distance is 2 |dt| along the normal, and S is 10 plus half the diagonal of the ball's box.
  const double unit = 0x1p-24 * (10.0 + std::sqrt(3.0)) / 2.0;
  const double ulp = 0x1p-21;
  for (const int steps : {1, 5, 11, 12, 40}) {
    const PieceDifference difference =
        compare_one(make_hit(0, 4.5F), make_hit(0, 4.5F + static_cast<float>(steps * ulp)));
    const double k = steps * ulp / unit;
    EXPECT_EQ(difference.mismatches, k > 16.0 ? 1U : 0U) << k;
    EXPECT_NEAR(difference.largest, k > 16.0 ? 0.0 : k, 1e-3) << steps;
  }
  // At grazing incidence the point moves along the surface.
  Hit grazing = make_hit(0, 4.5F);
  grazing.normal = vec3(1, 0, 0);
  EXPECT_EQ(compare_one(grazing, make_hit(0, 4.6F)).mismatches, 0U);
}

TEST(HitComparisonTest, OfAPlaneSHasTheWayToo) {
  const PieceDifference difference = compare_one(make_hit(1, 50.0F), make_hit(1, 50.0F + 0x1p-18F));
  EXPECT_NEAR(difference.largest, 2.0 * 0x1p-18 / (0x1p-24 * 100.0), 1e-3);
}

TEST(HitComparisonTest, OtherSurfacesAreOthers) {
  EXPECT_EQ(compare_one(make_hit(0, 4.5F), make_hit(1, 4.5F)).mismatches, 1U);
  EXPECT_EQ(compare_one(make_hit(0, 4.5F), Hit()).mismatches, 1U);
  EXPECT_EQ(compare_one(Hit(), Hit()).mismatches, 0U);
  Hit neighbour = make_hit(0, 4.5F);
  neighbour.primitive = 1;
  EXPECT_EQ(compare_one(make_hit(0, 4.5F), neighbour).mismatches, 1U);
  EXPECT_EQ(compare_one(make_hit(0, std::numeric_limits<float>::quiet_NaN()), make_hit(0, 4.5F)).mismatches, 1U);
  // The object does not exist.
  EXPECT_EQ(compare_one(make_hit(5, 4.5F), make_hit(5, 4.500001F)).mismatches, 1U);
}

TEST(HitComparisonTest, ListsAndCountsAreOfRays) {
  const std::vector<Hit> there = {make_hit(0, 4.5F), make_hit(0, 5.5F)};
  std::vector<Hit> anew = there;
  HitComparison comparison(make_scene());
  comparison.compare_lists(make_ray(), there, anew);
  anew[1].t += 0x1p-21F;
  comparison.compare_lists(make_ray(), there, anew);
  EXPECT_EQ(comparison.difference().mismatches, 0U);
  EXPECT_GT(comparison.difference().largest, 0.1);
  anew.pop_back();
  comparison.compare_lists(make_ray(), there, anew);
  EXPECT_EQ(comparison.difference().count, 3U);
  EXPECT_EQ(comparison.difference().mismatches, 1U);
  const std::vector<int32_t> counts = {1, 2, 3};
  const std::vector<int32_t> others = {1, 2, 4};
  comparison.compare(counts, others);
  EXPECT_EQ(comparison.difference().count, 6U);
  EXPECT_EQ(comparison.difference().mismatches, 2U);
}

}  // namespace
}  // namespace promin::work
