// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <vector>

namespace promin {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
constexpr SceneCube kUnitCube{vec3(0.0F), 1.0F};

/// Rays of some pixels, row by row, and the pixels themselves.
struct Pixels {
  std::vector<Ray> rays;
  std::vector<uvec2> places;
};

/// Returns the chosen pixels of a picture of that size, each with the ray that a camera has there.
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

/// Chooses a disk with a hole and a gap across: rows have all lengths, and some are in two or three pieces.
bool choose_ring(uvec2 pixel) {
  const vec2 p = vec2(pixel) - vec2(300.0F);
  const float distance = glm::length(p);
  return distance < 290.0F && (distance > 60.0F || p.y > 20.0F) && !(p.x > 100.0F && p.x < 120.0F);
}

Ray make_camera_ray(vec2 p) {
  return {vec3(0.0F, 0.0F, 3.0F), 0.0F, vec3(p, -1.0F)};
}

/// Returns a ray from a bulging surface with a step in it to a light.
Ray make_shadow_ray(vec2 p) {
  const vec3 origin(p, (p.x > 0.2F ? -0.5F : 0.0F) + 0.3F * glm::dot(p, p));
  return {origin, 0.0F, vec3(2.0F, 3.0F, 4.0F) - origin};
}

std::vector<uint32_t> tile(const std::vector<Ray>& rays) {
  RayTiler tiler;
  const std::span<const uint32_t> order = tiler.tile(rays, kUnitCube);
  return {order.begin(), order.end()};
}

void expect_permutation(std::vector<uint32_t> order, size_t count) {
  ASSERT_EQ(order.size(), count);
  std::sort(order.begin(), order.end());
  for (uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

/// Returns the order of all pixels, and expects that none is left out.
std::vector<uint32_t> tile_all(const Pixels& pixels) {
  std::vector<uint32_t> order = tile(pixels.rays);
  expect_permutation(order, pixels.rays.size());
  return order;
}

/// Returns the width and height of the pixels [first, first + count) of an order.
uvec2 extent_of(const Pixels& pixels, const std::vector<uint32_t>& order, size_t first, size_t count) {
  uvec2 lo(std::numeric_limits<uint32_t>::max());
  uvec2 hi(0);
  for (size_t i = first; i < first + count; ++i) {
    lo = glm::min(lo, pixels.places[order[i]]);
    hi = glm::max(hi, pixels.places[order[i]]);
  }
  return hi - lo + 1U;
}

/// Returns the fraction of an order's groups of four that lie in a rectangle of this many pixels.
double fraction_of_fours(const Pixels& pixels, const std::vector<uint32_t>& order, uvec2 most) {
  const size_t fours = order.size() / 4;
  size_t small = 0;
  for (size_t i = 0; i < fours; ++i) {
    small += glm::all(glm::lessThanEqual(extent_of(pixels, order, 4 * i, 4), most)) ? 1 : 0;
  }
  return static_cast<double>(small) / static_cast<double>(fours);
}

TEST(RayTiles, APictureIsTiledByEightTimesFourPixelsInFoursOfTwoByTwo) {
  for (const uvec2 size : {uvec2(1024, 256), uvec2(56, 100)}) {
    const Pixels pixels = make_pixels(size, choose_all, make_camera_ray);
    const std::vector<uint32_t> order = tile_all(pixels);
    EXPECT_EQ(fraction_of_fours(pixels, order, {2, 2}), 1.0);
    for (size_t i = 0; i < order.size(); i += 32) ASSERT_EQ(extent_of(pixels, order, i, 32), uvec2(8, 4)) << i;
  }
}

TEST(RayTiles, SizesThatAreNoMultiplesLoseFewFours) {
  for (const uvec2 size : {uvec2(1023, 77), uvec2(201, 203), uvec2(99, 1001)}) {
    const Pixels pixels = make_pixels(size, choose_all, make_camera_ray);
    const std::vector<uint32_t> order = tile_all(pixels);
    EXPECT_GT(fraction_of_fours(pixels, order, {2, 2}), 0.95) << size.x;
  }
}

TEST(RayTiles, ShadowRaysOfPartsOfAPictureAreMostlyInFoursOfNeighbours) {
  const Pixels pixels = make_pixels({600, 600}, choose_ring, make_shadow_ray);
  const std::vector<uint32_t> order = tile_all(pixels);
  // In the original order, the four rays of a group are in one row, or at the ends of two rows.
  EXPECT_GT(fraction_of_fours(pixels, order, {3, 2}), 0.9);
  EXPECT_GT(fraction_of_fours(pixels, order, {8, 4}), 0.98);
}

// The window in which the next row is expected to end also contains the end of the second of two rows of half the
// length.
TEST(RayTiles, RowsMayBecomeHalfAsLongAtOnce) {
  const auto choose_t = [](uvec2 pixel) { return pixel.y < 64 || pixel.x < 100; };
  const Pixels pixels = make_pixels({200, 200}, choose_t, make_camera_ray);
  const std::vector<uint32_t> order = tile_all(pixels);
  EXPECT_GT(fraction_of_fours(pixels, order, {2, 2}), 0.98);
}

TEST(RayTiles, RowsThatBeginHereAndThereStayBesideEachOther) {
  const auto choose_zigzag = [](uvec2 pixel) {
    const uint32_t first = 10 + std::array<uint32_t, 4>{0, 0, 1, 2}[(pixel.y * 7 + pixel.y / 4) % 4];
    return pixel.x >= first && pixel.x < first + 150;
  };
  const Pixels pixels = make_pixels({200, 200}, choose_zigzag, make_camera_ray);
  const std::vector<uint32_t> order = tile_all(pixels);
  EXPECT_GT(fraction_of_fours(pixels, order, {4, 2}), 0.97);
  EXPECT_GT(fraction_of_fours(pixels, order, {3, 2}), 0.85);
}

// The groups of four before the last row begin at multiples of four. This may need all remaining rays of the last row.
TEST(RayTiles, TheLastRowMayBeOneRay) {
  const auto choose = [](uvec2 pixel) { return pixel != uvec2(0) && (pixel.y < 64 || pixel.x == 0); };
  const Pixels pixels = make_pixels({100, 65}, choose, make_camera_ray);
  ASSERT_EQ(pixels.rays.size(), 6400U);
  tile_all(pixels);
}

TEST(RayTiles, AnyPartOfAPictureIsTiled) {
  for (uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
    const uvec2 size(50 + pick(100), 8 + pick(200));
    std::vector<uvec2> ranges(size.y);
    uint32_t last = pick(20);
    for (uvec2& range : ranges) {
      last = pick(8) == 0 ? pick(size.x) : last;
      range = {last, size.x - pick(4)};
    }
    const uint32_t dropped = pick(4) == 0 ? 100 : 0;
    Pixels pixels = make_pixels(
        size, [&](uvec2 p) { return p.x >= ranges[p.y].x && p.x < ranges[p.y].y && !(pick(1000) < dropped); },
        seed % 2 == 0 ? make_camera_ray : make_shadow_ray);
    pixels.rays.resize(pixels.rays.size() - pick(size.x));
    const std::vector<uint32_t> order = tile(pixels.rays);
    if (!order.empty()) expect_permutation(order, pixels.rays.size());
  }
}

TEST(RayTiles, WhatComesInNoRowsIsLeft) {
  std::vector<Ray> rays = make_pixels({256, 256}, choose_all, make_camera_ray).rays;
  EXPECT_TRUE(tile({}).empty());
  EXPECT_TRUE(tile({rays.front()}).empty());
  EXPECT_TRUE(tile({rays.begin(), rays.begin() + 256}).empty());
  EXPECT_TRUE(tile(std::vector<Ray>(1000, rays.front())).empty());
  // Rows have six pixels: in the original order, neighbours are already near.
  EXPECT_TRUE(tile(make_pixels({6, 500}, choose_all, make_camera_ray).rays).empty());
}

// In such a case only the order may be worse.
TEST(RayTiles, IsAPermutationWhateverTheRays) {
  const Pixels pixels = make_pixels({300, 100}, choose_all, make_camera_ray);
  std::vector<Ray> bad = pixels.rays;
  for (size_t i = 5; i < bad.size(); i += 37) bad[i].origin.x = kMissing;
  for (size_t i = 7; i < bad.size(); i += 41) bad[i].direction = vec3(0.0F);
  for (size_t i = 11; i < bad.size(); i += 43) bad[i].origin = vec3(1e38F);
  std::vector<Ray> shuffled = pixels.rays;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  std::vector<Ray> back_and_forth = pixels.rays;
  for (size_t row = 1; row < 100; row += 2) {
    std::reverse(back_and_forth.begin() + row * 300, back_and_forth.begin() + (row + 1) * 300);
  }
  ASSERT_FALSE(tile(bad).empty());
  for (const std::vector<Ray>& rays : {bad, shuffled, back_and_forth}) {
    for (const SceneCube& cube : {kUnitCube, SceneCube{}}) {
      RayTiler tiler;
      const std::span<const uint32_t> order = tiler.tile(rays, cube);
      if (!order.empty()) expect_permutation({order.begin(), order.end()}, rays.size());
    }
  }
}

TEST(RayTiles, ATilerForgetsWhatItTiledBefore) {
  RayTiler tiler;
  tiler.tile(make_pixels({600, 600}, choose_ring, make_shadow_ray).rays, kUnitCube);
  const std::vector<Ray> rays = make_pixels({200, 90}, choose_all, make_camera_ray).rays;
  const std::span<const uint32_t> order = tiler.tile(rays, kUnitCube);
  ASSERT_FALSE(order.empty());
  EXPECT_EQ(std::vector<uint32_t>(order.begin(), order.end()), tile(rays));
}

}  // namespace
}  // namespace promin
