// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace promin {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr SceneCube kCube{vec3(0.0F), 1.0F};

/// Rays of some pixels, row by row, and which pixels these are.
struct Pixels {
  std::vector<Ray> rays;
  std::vector<uvec2> places;
};

/// Of a picture of that size the pixels that are chosen, each with what a camera asks there.
Pixels make_pixels(const uvec2& size, const std::function<bool(uvec2)>& is_chosen,
                   const std::function<Ray(vec2)>& ray_of) {
  Pixels pixels;
  for (uint32_t y = 0; y < size.y; ++y) {
    for (uint32_t x = 0; x < size.x; ++x) {
      if (!is_chosen({x, y})) continue;
      pixels.places.emplace_back(x, y);
      pixels.rays.push_back(ray_of((vec2(x, y) + 0.5F) / static_cast<float>(size.x) - 0.5F));
    }
  }
  return pixels;
}

bool choose_all(uvec2 /*pixel*/) {
  return true;
}

/// A disk with a hole and a gap across: rows of all lengths, some in two or three pieces.
bool choose_ring(uvec2 pixel) {
  const vec2 p = vec2(pixel) - vec2(300.0F);
  const float distance = glm::length(p);
  return distance < 290.0F && (distance > 60.0F || p.y > 20.0F) && !(p.x > 100.0F && p.x < 120.0F);
}

Ray make_camera_ray(vec2 p) {
  return {vec3(0.0F, 0.0F, 3.0F), 0.0F, vec3(p, -1.0F)};
}

/// From a bulging surface with a step in it to a light.
Ray make_shadow_ray(vec2 p) {
  const vec3 origin(p, (p.x > 0.2F ? -0.5F : 0.0F) + 0.3F * glm::dot(p, p));
  return {origin, 0.0F, vec3(2.0F, 3.0F, 4.0F) - origin};
}

std::vector<uint32_t> tile(const std::vector<Ray>& rays) {
  RayTiler tiler;
  const std::span<const uint32_t> order = tiler.tile(rays, kCube);
  return {order.begin(), order.end()};
}

void expect_permutation(std::vector<uint32_t> order, size_t count) {
  ASSERT_EQ(order.size(), count);
  std::sort(order.begin(), order.end());
  for (uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

/// Width and height of the pixels [first, first + count) of an order.
uvec2 extent_of(const Pixels& pixels, const std::vector<uint32_t>& order, size_t first, size_t count) {
  uvec2 lo(std::numeric_limits<uint32_t>::max());
  uvec2 hi(0);
  for (size_t i = first; i < first + count; ++i) {
    lo = glm::min(lo, pixels.places[order[i]]);
    hi = glm::max(hi, pixels.places[order[i]]);
  }
  return hi - lo + 1U;
}

/// How many of an order's fours are in so small a rectangle of pixels.
double fraction_of_fours(const Pixels& pixels, const std::vector<uint32_t>& order, uvec2 most) {
  size_t small = 0;
  for (size_t i = 0; i + 4 <= order.size(); i += 4) {
    small += glm::all(glm::lessThanEqual(extent_of(pixels, order, i, 4), most)) ? 1 : 0;
  }
  return static_cast<double>(small) / static_cast<double>(order.size() / 4);
}

TEST(RayTiles, APictureIsTiledByEightTimesFourPixelsInFoursOfTwoByTwo) {
  for (const uvec2 size : {uvec2(1024, 256), uvec2(64, 100)}) {
    const Pixels pixels = make_pixels(size, choose_all, make_camera_ray);
    const std::vector<uint32_t> order = tile(pixels.rays);
    expect_permutation(order, pixels.rays.size());
    EXPECT_EQ(fraction_of_fours(pixels, order, {2, 2}), 1.0);
    for (size_t i = 0; i < order.size(); i += 32) ASSERT_EQ(extent_of(pixels, order, i, 32), uvec2(8, 4)) << i;
  }
}

TEST(RayTiles, SizesThatAreNoMultiplesLoseFewFours) {
  for (const uvec2 size : {uvec2(1023, 77), uvec2(201, 203), uvec2(99, 1001)}) {
    const Pixels pixels = make_pixels(size, choose_all, make_camera_ray);
    const std::vector<uint32_t> order = tile(pixels.rays);
    expect_permutation(order, pixels.rays.size());
    EXPECT_GT(fraction_of_fours(pixels, order, {2, 2}), 0.95) << size.x;
  }
}

TEST(RayTiles, ShadowRaysOfPartsOfAPictureAreMostlyInFoursOfNeighbours) {
  const Pixels pixels = make_pixels({600, 600}, choose_ring, make_shadow_ray);
  const std::vector<uint32_t> order = tile(pixels.rays);
  expect_permutation(order, pixels.rays.size());
  // As they come, no four is but of one row, or of the ends of two.
  EXPECT_GT(fraction_of_fours(pixels, order, {3, 2}), 0.9);
  EXPECT_GT(fraction_of_fours(pixels, order, {8, 4}), 0.98);
}

TEST(RayTiles, WhatComesInNoRowsIsLeft) {
  std::vector<Ray> rays = make_pixels({256, 256}, choose_all, make_camera_ray).rays;
  EXPECT_TRUE(tile({}).empty());
  EXPECT_TRUE(tile({rays.front()}).empty());
  EXPECT_TRUE(tile({rays.begin(), rays.begin() + 256}).empty());
  EXPECT_TRUE(tile(std::vector<Ray>(1000, rays.front())).empty());
  // Rows of six pixels: as they come, neighbours are near.
  EXPECT_TRUE(tile(make_pixels({6, 500}, choose_all, make_camera_ray).rays).empty());
}

// Order is all that may suffer.
TEST(RayTiles, IsAPermutationWhateverTheRays) {
  const Pixels pixels = make_pixels({300, 100}, choose_all, make_camera_ray);
  std::vector<Ray> bad = pixels.rays;
  for (size_t i = 0; i < bad.size(); i += 37) bad[i].origin.x = kNan;
  for (size_t i = 0; i < bad.size(); i += 41) bad[i].direction = vec3(0.0F);
  for (size_t i = 0; i < bad.size(); i += 43) bad[i].origin = vec3(1e38F);
  std::vector<Ray> shuffled = pixels.rays;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  std::vector<Ray> back_and_forth = pixels.rays;
  for (size_t row = 1; row < 100; row += 2) {
    std::reverse(back_and_forth.begin() + row * 300, back_and_forth.begin() + (row + 1) * 300);
  }
  for (const std::vector<Ray>& rays : {bad, shuffled, back_and_forth}) {
    const std::vector<uint32_t> order = tile(rays);
    if (!order.empty()) expect_permutation(order, rays.size());
    RayTiler tiler;
    tiler.tile(rays, SceneCube{});
  }
}

TEST(RayTiles, ATilerForgetsWhatItTiledBefore) {
  RayTiler tiler;
  tiler.tile(make_pixels({600, 600}, choose_ring, make_shadow_ray).rays, kCube);
  const std::vector<Ray> rays = make_pixels({200, 90}, choose_all, make_camera_ray).rays;
  const std::span<const uint32_t> order = tiler.tile(rays, kCube);
  EXPECT_EQ(std::vector<uint32_t>(order.begin(), order.end()), tile(rays));
}

}  // namespace
}  // namespace promin
