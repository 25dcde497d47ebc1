// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace promin {
namespace {

/// Returns the row of the i-th sample, as shaders/picture/camera.glsl computes it.
uint32_t row_of(uint32_t index, uint32_t count, uint32_t generator) {
  return static_cast<uint32_t>((static_cast<uint64_t>(generator) * (index + 1)) % (count + 1)) - 1;
}

class SamplingTest : public testing::TestWithParam<uint32_t> {};

TEST_P(SamplingTest, EachRowHasOneSampleAndTheCentreIsTheMean) {
  const uint32_t count = GetParam();
  const uint32_t generator = lattice_generator(count);
  std::vector<int> hits(count, 0);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t row = row_of(i, count, generator);
    ASSERT_LT(row, count);
    ++hits[row];
    EXPECT_EQ(row + row_of(count - 1 - i, count, generator), count - 1) << "not symmetric about the centre";
  }
  for (const int hit : hits) EXPECT_EQ(hit, 1);
}

INSTANTIATE_TEST_SUITE_P(Counts, SamplingTest,
                         testing::Values(1U, 2U, 3U, 4U, 5U, 8U, 16U, 64U, 100U, 128U, 129U, 1000U, 65535U));

/// Returns the weight of a filter with a width of 2; it is not normalised.
double weight_of(PixelFilter filter, double x) {
  const double t = 0.5 * (1.0 + x);
  constexpr double kTurn = 2.0 * std::numbers::pi;
  switch (filter) {
    case PixelFilter::kBox:
      return 1.0;
    case PixelFilter::kTent:
      return 1.0 - std::abs(x);
    case PixelFilter::kGauss:
      return std::exp(-4.5 * x * x);
    case PixelFilter::kBlackmanHarris:
      return 0.35875 - 0.48829 * std::cos(kTurn * t) + 0.14128 * std::cos(2 * kTurn * t) -
             0.01168 * std::cos(3 * kTurn * t);
  }
  return 0.0;
}

// The fraction of samples before a position equals the fraction of the filter's weight before it. The test sums the
// weight over small steps.
TEST(PixelFilterTest, SamplesAreAsDenseAsTheWeight) {
  for (size_t number = 0; number < pixel_filter_names().size(); ++number) {
    const auto filter = static_cast<PixelFilter>(number);
    SCOPED_TRACE(pixel_filter_names()[number]);
    constexpr int kSteps = 1 << 18;
    double total = 0.0;
    for (int i = 0; i < kSteps; ++i) total += weight_of(filter, (2 * i + 1.0) / kSteps - 1);
    double before = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      before += weight_of(filter, (2 * i + 1.0) / kSteps - 1) / total;
      if ((i + 1) % 8192 != 0 || i + 1 == kSteps) continue;
      EXPECT_NEAR(place_of_share(filter, 5.0, before), 2.5 * (2 * (i + 1.0) / kSteps - 1),
                  2e-5 / weight_of(filter, 2 * (i + 1.0) / kSteps - 1))
          << before;
    }
    EXPECT_NEAR(place_of_share(filter, 5.0, 0.5), 0.0, 1e-15) << "symmetric";
    EXPECT_NEAR(place_of_share(filter, 5.0, 0.3), -place_of_share(filter, 5.0, 0.7), 1e-14);
    EXPECT_GE(place_of_share(filter, 5.0, 0.0), -2.5);
    EXPECT_LE(place_of_share(filter, 5.0, 1.0), 2.5);
  }
}

TEST(PixelFilterTest, PointsOfTheLatticeAreMoved) {
  View view;
  view.samples_per_pixel = 4;
  const uint32_t generator = lattice_generator(4);
  EXPECT_EQ(sample_point(view, generator, 0).x, 0.125F);
  EXPECT_EQ(sample_point(view, generator, 3).x, 0.875F);
  view.filter_width = 3.0F;
  EXPECT_FLOAT_EQ(sample_point(view, generator, 0).x, 0.5F - 3.0F * 0.375F);
  view.filter = PixelFilter::kTent;
  view.filter_width = 2.0F;
  EXPECT_FLOAT_EQ(sample_point(view, generator, 0).x, 0.5F - (1.0F - 0.5F));
  view.samples_per_pixel = 1;
  for (const PixelFilter filter : {PixelFilter::kBox, PixelFilter::kGauss, PixelFilter::kBlackmanHarris}) {
    view.filter = filter;
    EXPECT_EQ(sample_point(view, 1, 0), vec2(0.5F)) << "the centre";
  }
}

TEST(SampleLatticeTest, FourSamplesAreTheRotatedGrid) {
  const uint32_t generator = lattice_generator(4);
  std::vector<uint32_t> rows;
  for (uint32_t i = 0; i < 4; ++i) rows.push_back(row_of(i, 4, generator));
  EXPECT_TRUE(rows == (std::vector<uint32_t>{1, 3, 0, 2}) || rows == (std::vector<uint32_t>{2, 0, 3, 1}));
}

}  // namespace
}  // namespace promin
