// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "promin/compare.h"
#include "promin/error.h"

namespace promin {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Image make_flat(const uvec2& size, const vec3& color) {
  return {size, std::vector<vec3>(static_cast<size_t>(size.x) * size.y, color)};
}

/// Returns stripes, cells and gradients of all colours.
Image make_pattern() {
  Image image = make_flat({60, 44}, vec3(0));
  for (uint32_t y = 0; y < image.size.y; ++y) {
    for (uint32_t x = 0; x < image.size.x; ++x) {
      for (uint32_t c = 0; c < 3; ++c) {
        const uint32_t number = (x * (7 + 4 * c) + y * (13 - 3 * c) + (x / 8) * (y / 8) * 5) % 64;
        image.at(x, y)[static_cast<int>(c)] = static_cast<float>(number / 63.0);
      }
    }
  }
  return image;
}

/// Adds a disc of another colour and a line to the picture.
Image change(Image image) {
  for (uint32_t y = 0; y < image.size.y; ++y) {
    for (uint32_t x = 0; x < image.size.x; ++x) {
      const double dx = x - 30.0;
      const double dy = y - 20.0;
      vec3& pixel = image.at(x, y);
      if (dx * dx + dy * dy < 100.0) pixel = pixel * 0.5F + vec3(0, 0.25F, 0);
      if (x == 10) pixel = vec3(1, 1, 0);
    }
  }
  return image;
}

TEST(ComparePicturesTest, EqualPicturesDoNotDiffer) {
  const PictureDifference difference = compare_pictures(make_pattern(), make_pattern());
  EXPECT_EQ(difference.pixel_count, 60U * 44U);
  EXPECT_EQ(difference.mean, 0.0);
  EXPECT_EQ(difference.rmse, 0.0);
  EXPECT_EQ(difference.psnr_db, kInfinity);
  EXPECT_EQ(difference.largest, 0.0);
  EXPECT_EQ(difference.different_count, 0U);
  EXPECT_EQ(difference.flip, 0.0);
}

TEST(ComparePicturesTest, TheFiguresAreThoseOfTheNumbers) {
  const Image reference = make_flat({4, 2}, vec3(0.5F));
  Image test = reference;
  test.at(3, 0) = vec3(0.5F, 0.75F, 0.5F);
  test.at(1, 1) = vec3(0.25F, 0.5F, 0.0F);
  test.at(2, 1) = vec3(1.0F, 0.5F, 0.5F);
  const PictureDifference difference = compare_pictures(reference, test, {.fail = 0.25});
  EXPECT_DOUBLE_EQ(difference.mean, (0.25 + 0.25 + 0.5 + 0.5) / 24);
  EXPECT_DOUBLE_EQ(difference.rmse, std::sqrt((0.0625 + 0.0625 + 0.25 + 0.25) / 24));
  EXPECT_DOUBLE_EQ(difference.psnr_db, 20 * std::log10(1 / difference.rmse));
  EXPECT_EQ(difference.largest, 0.5);
  EXPECT_EQ(difference.largest_at, uvec2(1, 1)) << "the first";
  EXPECT_EQ(difference.different_count, 2U) << "more than 0.25";
  EXPECT_EQ(difference.non_finite_count, 0U);
}

TEST(ComparePicturesTest, WhatIsNoNumberDiffersFromAllOthers) {
  const Image reference = make_flat({3, 1}, vec3(1.0F));
  Image first = reference;
  Image second = reference;
  first.at(0, 0) = second.at(0, 0) = vec3(kNan, kInfinity, 0);
  const PictureDifference same = compare_pictures(first, second);
  EXPECT_EQ(same.largest, 0.0);
  EXPECT_EQ(same.non_finite_count, 1U);
  EXPECT_EQ(same.different_count, 0U);
  for (const float odd : {kNan, kInfinity}) {
    second = reference;
    second.at(1, 0).y = odd;
    const PictureDifference difference = compare_pictures(reference, second, {.fail = 1e9});
    EXPECT_EQ(difference.largest, kInfinity);
    EXPECT_EQ(difference.largest_at, uvec2(1, 0));
    EXPECT_EQ(difference.different_count, 1U);
    EXPECT_EQ(difference.rmse, 0.0) << "of what is finite";
    EXPECT_TRUE(std::isfinite(difference.flip));
  }
}

TEST(ComparePicturesTest, OtherSizesAreRefused) {
  EXPECT_THROW(compare_pictures(make_flat({2, 3}, vec3(0)), make_flat({3, 2}, vec3(0))), InputError);
  EXPECT_THROW(compare_pictures(Image(), Image()), InputError);
}

TEST(ComparePicturesTest, AFileIsLinearByItsEnding) {
  EXPECT_EQ(encoding_of("a/b.EXR"), PictureEncoding::kLinear);
  EXPECT_EQ(encoding_of("b.hdr"), PictureEncoding::kLinear);
  EXPECT_EQ(encoding_of("b.png"), PictureEncoding::kSrgb);
  EXPECT_EQ(encoding_of("exr"), PictureEncoding::kSrgb);
}

// These numbers are from flip-evaluator 1.7, by the paper's authors, which computes in fp32.
TEST(FlipTest, AgreesWithItsAuthorsProgram) {
  const Image reference = make_pattern();
  const PictureDifference difference = compare_pictures(reference, change(reference));
  EXPECT_NEAR(difference.flip, 0.15706971, 1e-5);
  const std::pair<uvec2, double> places[] = {{{0, 0}, 0.005525},   {{10, 5}, 0.580485},  {{11, 30}, 0.492754},
                                             {{30, 20}, 0.636715}, {{25, 13}, 0.612628}, {{50, 40}, 0.0},
                                             {{9, 43}, 0.414640},  {{38, 26}, 0.375933}};
  for (const auto& [at, expected] : places) {
    EXPECT_NEAR(difference.flip_map[at.y * reference.size.x + at.x], expected, 1e-4) << at.x << " " << at.y;
  }
  const PictureDifference coded = compare_pictures(reference, change(reference), {.encoding = PictureEncoding::kSrgb});
  EXPECT_NEAR(coded.flip, 0.17990804, 1e-5);
  const PictureDifference near = compare_pictures(reference, change(reference), {.pixels_per_degree = 20.0});
  EXPECT_NEAR(near.flip, 0.13019671, 1e-5);
  EXPECT_NEAR(near.flip_map[13 * reference.size.x + 25], 0.7300504, 1e-4);
}

TEST(FlipTest, FlatColorsDifferAsInItsAuthorsProgram) {
  const Image black = make_flat({8, 8}, vec3(0));
  const std::pair<vec3, double> colors[] = {{vec3(1), 0.96738821},
                                            {vec3(0, 1, 0), 0.99697042},
                                            {vec3(0.5F), 0.95855027},
                                            {vec3(0.2F, 0.3F, 0.4F), 0.95582575}};
  for (const auto& [color, expected] : colors) {
    EXPECT_NEAR(compare_pictures(black, make_flat({8, 8}, color)).flip, expected, 1e-5);
    EXPECT_NEAR(compare_pictures(make_flat({8, 8}, color), black).flip, expected, 1e-5) << "symmetric";
  }
  EXPECT_EQ(compare_pictures(black, make_flat({8, 8}, vec3(-3))).flip, 0.0) << "clamped";
}

}  // namespace
}  // namespace promin
