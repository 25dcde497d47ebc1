// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/compare_images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "promin/error.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Image make_gray(uint32_t width, uint32_t height, float value) {
  Image image;
  image.size = uvec2(width, height);
  image.pixels.assign(static_cast<size_t>(width) * height, vec3(value));
  return image;
}

/// Returns a shaded disk on black with its centre at (x, y) in pixels, which looks like a small golden image.
Image make_disk(float x, float y) {
  Image image = make_gray(64, 64, 0.0F);
  for (uint32_t row = 0; row < 64; ++row) {
    for (uint32_t column = 0; column < 64; ++column) {
      const float dx = static_cast<float>(column) + 0.5F - x;
      const float dy = static_cast<float>(row) + 0.5F - y;
      const float height = 400.0F - dx * dx - dy * dy;
      if (height > 0.0F) image.at(column, row) = vec3(std::sqrt(height) / 20.0F);
    }
  }
  return image;
}

TEST(CompareTest, EqualPicturesAreEqual) {
  const ImageDifference result = compare_images(make_disk(32, 32), make_disk(32, 32));
  EXPECT_TRUE(result.is_equal);
  EXPECT_EQ(result.mean_absolute, 0.0);
  EXPECT_EQ(result.largest, 0.0F);
  EXPECT_TRUE(result.worst.empty());
}

TEST(CompareTest, AHalfPixelShiftFails) {
  EXPECT_FALSE(compare_images(make_disk(32, 32), make_disk(32.5F, 32)).is_equal);
  EXPECT_FALSE(compare_images(make_disk(32, 32), make_disk(32, 32.5F)).is_equal);
}

TEST(CompareTest, NonFinitePixelsFailEvenWhereBothHaveThem) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Image image = make_gray(8, 8, 0.5F);
    image.at(3, 2).y = bad;
    const ImageDifference result = compare_images(image, image);
    EXPECT_FALSE(result.is_equal);
    EXPECT_EQ(result.non_finite_count, 1U);
    EXPECT_EQ(result.failed_count, 1U);
    ASSERT_EQ(result.worst.size(), 1U);
    EXPECT_EQ(result.worst[0].pixel, uvec2(3, 2));
    EXPECT_FALSE(compare_images(make_gray(8, 8, 0.5F), image).is_equal);
    EXPECT_FALSE(compare_images(image, make_gray(8, 8, 0.5F)).is_equal);
  }
}

TEST(CompareTest, AShareOfSmallDifferencesIsAllowed) {
  const Image a = make_gray(100, 100, 0.5F);
  Image b = a;
  b.at(10, 20).x += 0.005F;
  b.at(11, 20).z -= 0.006F;
  EXPECT_TRUE(compare_images(a, b).is_equal) << "2 of 10000 pixels are 0.02 %";
  b.at(12, 20).y += 0.005F;
  const ImageDifference result = compare_images(a, b);
  EXPECT_FALSE(result.is_equal);
  EXPECT_EQ(result.failed_count, 3U);
  EXPECT_NEAR(result.failed_percent(), 0.03, 1e-12);
}

TEST(CompareTest, OneLargeDifferenceFails) {
  const Image a = make_gray(100, 100, 0.5F);
  Image b = a;
  b.at(99, 99).y += 0.013F;
  EXPECT_FALSE(compare_images(a, b).is_equal);
  CompareOptions loose;
  loose.hard_fail = 0.02F;
  EXPECT_TRUE(compare_images(a, b, loose).is_equal);
}

TEST(CompareTest, AShareOfEdgePixelsMayShowTheirNeighbour) {
  Image golden = make_gray(100, 100, 0.0F);
  for (uint32_t y = 0; y < 100; ++y) {
    for (uint32_t x = 50; x < 100; ++x) golden.at(x, y) = vec3(1.0F);
  }
  CompareOptions options;
  EXPECT_EQ(options.edge_percent, 0.0) << "edges are for those who ask for them";
  Image picture = golden;
  for (uint32_t y = 0; y < 50; ++y) picture.at(50, y) = vec3(y % 2 == 0 ? 0.0F : 0.7F);
  EXPECT_FALSE(compare_images(picture, golden, options).is_equal);
  options.edge_percent = 0.5;
  const ImageDifference result = compare_images(picture, golden, options);
  EXPECT_TRUE(result.is_equal) << "50 of 10000 pixels are 0.5 %";
  EXPECT_EQ(result.edge_count, 50U);
  EXPECT_EQ(result.failed_count, 0U);
  EXPECT_TRUE(result.worst.empty());
  EXPECT_THAT(result.summary(), HasSubstr("on edges 50"));

  picture.at(49, 99) = vec3(1.0F);
  EXPECT_FALSE(compare_images(picture, golden, options).is_equal) << "one more is too many";
  picture = golden;
  picture.at(50, 0) = vec3(0.0F, 1.0F, 1.013F);
  EXPECT_FALSE(compare_images(picture, golden, options).is_equal) << "brighter than all around it";
  picture = golden;
  picture.at(53, 0) = vec3(0.0F);
  EXPECT_FALSE(compare_images(picture, golden, options).is_equal) << "the edge is three pixels away";
  picture = golden;
  picture.at(50, 0).y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(compare_images(picture, golden, options).is_equal) << "NaN is between nothing";
}

TEST(CompareTest, TheWorstPixelsComeFirst) {
  const Image a = make_gray(10, 10, 0.0F);
  Image b = a;
  b.at(1, 5) = vec3(0.25F);
  b.at(7, 2) = vec3(0.0F, -0.5F, 0.0F);
  b.at(3, 5) = vec3(0.25F, 0.0F, 0.0F);
  CompareOptions options;
  options.worst_count = 2;
  const ImageDifference result = compare_images(a, b, options);
  ASSERT_EQ(result.worst.size(), 2U);
  EXPECT_EQ(result.worst[0].pixel, uvec2(7, 2));
  EXPECT_EQ(result.worst[0].difference, 0.5F);
  EXPECT_EQ(result.worst[1].pixel, uvec2(1, 5));
  EXPECT_EQ(result.largest, 0.5F);
  EXPECT_DOUBLE_EQ(result.mean_absolute, (0.75 + 0.5 + 0.25) / 300.0);
  EXPECT_THAT(result.summary(), HasSubstr("pixel (7, 2) differs by 0.5"));
}

TEST(CompareTest, SizesMustMatch) {
  EXPECT_THROW(compare_images(make_gray(3, 2, 0.0F), make_gray(2, 3, 0.0F)), InputError);
  EXPECT_THROW(compare_images(Image{}, Image{}), InputError);
}

TEST(CompareTest, TheDifferenceImageShowsWhere) {
  const fs::path file = fs::path(testing::TempDir()) / "promin_difference.exr";
  const Image a = make_gray(2, 1, 0.5F);
  Image b = a;
  b.at(0, 0).x = 0.25F;
  b.at(1, 0).x = std::numeric_limits<float>::quiet_NaN();
  write_difference_image(file, a, b, 2.0F);
  const Image difference = read_image(file);
  EXPECT_EQ(difference.at(0, 0), vec3(0.5F, 0.0F, 0.0F));
  EXPECT_EQ(difference.at(1, 0), vec3(1.0F, 0.0F, 1.0F));
  fs::remove(file);
}

}  // namespace
}  // namespace promin
