// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/scrambled_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "device_scene/sampling.h"

namespace promin {
namespace {

// Of the first 2^m points, each box of area 2^-m whose sides are powers of two has one point: 2^a columns of 2^(m - a)
// rows, for each a.
TEST(ScrambledPointsTest, FirstPointsAreNets) {
  for (const uvec2& pixel : {uvec2(0), uvec2(1, 0), uvec2(0, 1), uvec2(639, 17), uvec2(32767)}) {
    const ScrambledPoints points(pixel);
    for (uint32_t m = 0; m <= 10; ++m) {
      const uint32_t count = 1U << m;
      for (uint32_t a = 0; a <= m; ++a) {
        const uint32_t columns = 1U << a;
        const uint32_t rows = count / columns;
        std::vector<int> hits(count, 0);
        for (uint32_t i = 0; i < count; ++i) {
          const vec2 point = points.at(i);
          ++hits[static_cast<uint32_t>(point.y * static_cast<float>(rows)) * columns +
                 static_cast<uint32_t>(point.x * static_cast<float>(columns))];
        }
        for (const int hit : hits) ASSERT_EQ(hit, 1) << count << " points of pixel " << pixel.x << " " << pixel.y;
      }
    }
  }
}

// The same holds for any later batch of 2^m points.
TEST(ScrambledPointsTest, BatchesAreNetsToo) {
  const ScrambledPoints points(uvec2(3, 5));
  for (uint32_t first = 0; first < 256; first += 32) {
    std::vector<int> hits(32, 0);
    for (uint32_t i = 0; i < 32; ++i) {
      const vec2 point = points.at(first + i);
      ++hits[static_cast<uint32_t>(point.y * 8.0F) * 4 + static_cast<uint32_t>(point.x * 4.0F)];
    }
    for (const int hit : hits) EXPECT_EQ(hit, 1) << first;
  }
}

TEST(ScrambledPointsTest, CoordinatesAreExact) {
  for (uint32_t i = 0; i < 4096; ++i) {
    const vec2 point = ScrambledPoints(uvec2(i, 7 * i)).at(i);
    for (const float x : {point.x, point.y}) {
      ASSERT_GT(x, 0.0F);
      ASSERT_LT(x, 1.0F);
      ASSERT_EQ(std::fmod(x * 0x1p24F, 2.0F), 1.0F);
    }
  }
}

// Neighbouring pixels have different points: the first points of 64 pixels are as evenly spread as random ones.
TEST(ScrambledPointsTest, PixelsDiffer) {
  double sum = 0.0;
  double squares = 0.0;
  for (uint32_t i = 0; i < 4096; ++i) {
    const vec2 point = ScrambledPoints(uvec2(i % 64, i / 64)).at(0);
    const double off = static_cast<double>(point.x) - 0.5;
    sum += off;
    squares += off * off;
  }
  // A uniform variable has the variance 1/12.
  EXPECT_NEAR(sum / 4096, 0.0, 4.0 / std::sqrt(12.0 * 4096));
  EXPECT_NEAR(squares / 4096, 1.0 / 12.0, 0.006);
}

TEST(FilterPlacesTest, AreThoseOfTheSharesOfTheFilter) {
  for (size_t number = 0; number < pixel_filter_names().size(); ++number) {
    View view;
    view.filter = static_cast<PixelFilter>(number);
    view.filter_width = default_width(view.filter);
    const FilterPlaces places(view);
    for (int i = 1; i < 4096; i += 3) {
      const double share = (i + 0.37) / 4097.0;
      const auto width = static_cast<double>(view.filter_width);
      const double expected = 0.5 + place_of_share(view.filter, width, share);
      // At the ends of a filter, where its weight is almost 0, small steps of the fraction are far apart.
      const double tolerance = share > 0.002 && share < 0.998 ? 2e-3 : 0.06;
      ASSERT_NEAR(places.at(vec2(static_cast<float>(share), 0.5F)).x, expected, tolerance)
          << pixel_filter_names()[number] << " " << share;
    }
    EXPECT_NEAR(places.at(vec2(0.5F)).y, 0.5, 1e-6);
  }
}

}  // namespace
}  // namespace promin
