// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

namespace promin {
namespace {

constexpr float kUnboundedRay = std::numeric_limits<float>::infinity();
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

/// Returns a camera's rays, pixel by pixel, towards a cube of half side 1 at the origin.
std::vector<Ray> make_camera_rays(uint32_t width, uint32_t height) {
  std::vector<Ray> rays;
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const vec3 direction((static_cast<float>(x) + 0.5F) / static_cast<float>(width) - 0.5F,
                           0.5F - (static_cast<float>(y) + 0.5F) / static_cast<float>(height), -1.0F);
      rays.push_back({vec3(0.0F, 0.0F, 3.0F), 0.0F, direction, kUnboundedRay});
    }
  }
  return rays;
}

std::vector<Ray> shuffle(std::vector<Ray> rays) {
  std::shuffle(rays.begin(), rays.end(), std::mt19937(3));
  return rays;
}

constexpr SceneCube kCube{vec3(0.0F), 1.0F};

std::vector<uint32_t> sort(const std::vector<Ray>& rays, const SceneCube& cube) {
  RaySorter sorter;
  const std::span<const uint32_t> order = sorter.sort(rays, cube);
  return {order.begin(), order.end()};
}

TEST(RayOrder, PixelsAreSideBySideAtAnyWidth) {
  // With these widths, samples at even steps would all be at the ends of rows.
  for (const uint32_t width : {16U, 100U, 1023U, 1024U, 1025U}) {
    EXPECT_EQ(are_side_by_side(make_camera_rays(width, 1024), kCube), true) << width;
  }
}

TEST(RayOrder, ShuffledRaysAreNotSideBySide) {
  EXPECT_FALSE(are_side_by_side(shuffle(make_camera_rays(256, 256)), kCube));
}

TEST(RayOrder, FewRaysAreSideBySide) {
  EXPECT_TRUE(are_side_by_side({}, kCube));
  EXPECT_TRUE(are_side_by_side(make_camera_rays(1, 1), kCube));
}

TEST(RayOrder, SortedRaysAreSideBySide) {
  const std::vector<Ray> rays = shuffle(make_camera_rays(256, 256));
  std::vector<Ray> sorted;
  for (const uint32_t i : sort(rays, kCube)) sorted.push_back(rays[i]);
  EXPECT_TRUE(are_side_by_side(sorted, kCube));
}

TEST(RayOrder, IsAPermutation) {
  std::vector<Ray> rays = shuffle(make_camera_rays(300, 100));
  rays[5].origin.x = kNotANumber;
  rays[6].direction = vec3(0.0F);
  rays[7].direction = vec3(kUnboundedRay, 1.0F, 0.0F);
  rays[8].origin = vec3(1e38F);
  std::vector<uint32_t> order = sort(rays, kCube);
  std::sort(order.begin(), order.end());
  for (uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  EXPECT_TRUE(sort({}, kCube).empty());
}

TEST(RayOrder, RaysThatMissTheCubeComeLastInTheirOrder) {
  const Ray hit{vec3(0.0F, 0.0F, 3.0F), 0.0F, vec3(0.0F, 0.0F, -1.0F), kUnboundedRay};
  const Ray away{vec3(0.0F, 0.0F, 3.0F), 0.0F, vec3(0.0F, 0.0F, 1.0F), kUnboundedRay};
  const Ray beside{vec3(2.0F, 0.0F, 3.0F), 0.0F, vec3(0.0F, 0.0F, -1.0F), kUnboundedRay};
  const Ray invalid{vec3(kNotANumber), 0.0F, vec3(0.0F, 0.0F, -1.0F), kUnboundedRay};
  const std::vector<Ray> rays = {away, hit, invalid, beside, hit};
  EXPECT_EQ(sort(rays, kCube), (std::vector<uint32_t>{1, 4, 0, 2, 3}));
}

TEST(RayOrder, RaysThatAreTheSameKeepTheirOrderWhichThreadEverTakesThem) {
  // There are enough rays for several threads, and not a whole number of blocks.
  const std::vector<Ray> kinds = shuffle(make_camera_rays(5, 5));
  std::vector<Ray> rays;
  for (size_t i = 0; i < 70'001; ++i) rays.push_back(kinds[(i * i + i / 7) % kinds.size()]);
  const std::vector<uint32_t> order = sort(rays, kCube);
  ASSERT_EQ(order.size(), rays.size());
  size_t changes = 0;
  for (size_t i = 1; i < order.size(); ++i) {
    if (rays[order[i]].direction == rays[order[i - 1]].direction) {
      ASSERT_LT(order[i - 1], order[i]);
    } else {
      ++changes;
    }
  }
  EXPECT_LT(changes, kinds.size());
}

TEST(RayOrder, ASorterForgetsWhatItSortedBefore) {
  RaySorter sorter;
  sorter.sort(make_camera_rays(64, 64), kCube);
  const std::vector<Ray> rays = shuffle(make_camera_rays(20, 10));
  const std::span<const uint32_t> order = sorter.sort(rays, kCube);
  EXPECT_EQ(std::vector<uint32_t>(order.begin(), order.end()), sort(rays, kCube));
}

TEST(RayOrder, AScenelessCubeIsNoTrouble) {
  const std::vector<Ray> rays = make_camera_rays(4, 4);
  EXPECT_EQ(sort(rays, SceneCube{}).size(), rays.size());
}

}  // namespace
}  // namespace promin
