// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace promin {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A camera's, pixel by pixel, of a cube of half side 1 at the origin.
std::vector<Ray> make_camera_rays(uint32_t width, uint32_t height) {
  std::vector<Ray> rays;
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const vec3 direction((static_cast<float>(x) + 0.5F) / static_cast<float>(width) - 0.5F,
                           0.5F - (static_cast<float>(y) + 0.5F) / static_cast<float>(height), -1.0F);
      rays.push_back({vec3(0.0F, 0.0F, 3.0F), 0.0F, direction, kInfinity});
    }
  }
  return rays;
}

std::vector<Ray> shuffle(std::vector<Ray> rays) {
  std::shuffle(rays.begin(), rays.end(), std::mt19937(3));
  return rays;
}

constexpr SceneCube kCube{vec3(0.0F), 1.0F};

TEST(RayOrder, PixelsAreSideBySideAtAnyWidth) {
  // Widths for which samples at even steps would all fall on the ends of rows.
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
  for (const uint32_t i : sort_rays(rays, kCube)) sorted.push_back(rays[i]);
  EXPECT_TRUE(are_side_by_side(sorted, kCube));
}

TEST(RayOrder, IsAPermutation) {
  std::vector<Ray> rays = shuffle(make_camera_rays(300, 100));
  rays[5].origin.x = kNan;
  rays[6].direction = vec3(0.0F);
  rays[7].direction = vec3(kInfinity, 1.0F, 0.0F);
  rays[8].origin = vec3(1e38F);
  std::vector<uint32_t> order = sort_rays(rays, kCube);
  std::sort(order.begin(), order.end());
  for (uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  EXPECT_TRUE(sort_rays({}, kCube).empty());
}

TEST(RayOrder, RaysThatMissTheCubeComeLastInTheirOrder) {
  const Ray hit{vec3(0.0F, 0.0F, 3.0F), 0.0F, vec3(0.0F, 0.0F, -1.0F), kInfinity};
  const Ray away{vec3(0.0F, 0.0F, 3.0F), 0.0F, vec3(0.0F, 0.0F, 1.0F), kInfinity};
  const Ray beside{vec3(2.0F, 0.0F, 3.0F), 0.0F, vec3(0.0F, 0.0F, -1.0F), kInfinity};
  const Ray invalid{vec3(kNan), 0.0F, vec3(0.0F, 0.0F, -1.0F), kInfinity};
  const std::vector<Ray> rays = {away, hit, invalid, beside, hit};
  EXPECT_EQ(sort_rays(rays, kCube), (std::vector<uint32_t>{1, 4, 0, 2, 3}));
}

TEST(RayOrder, AScenelessCubeIsNoTrouble) {
  const std::vector<Ray> rays = make_camera_rays(4, 4);
  EXPECT_EQ(sort_rays(rays, SceneCube{}).size(), rays.size());
}

}  // namespace
}  // namespace promin
