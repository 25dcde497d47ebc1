// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check the sample points of lights and lenses. The device computes the same points, which
// tests/gpu/soft_light_test.cpp checks.
#include "oracle/samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace promin::oracle {
namespace {

/// Returns whether each box of area 1 / 2^m with sides that are powers of two holds one of 2^m points.
bool are_net(const std::vector<std::array<Real, 2>>& points) {
  const size_t count = points.size();
  for (size_t columns = 1; columns <= count; columns *= 2) {
    const size_t rows = count / columns;
    std::vector<int> hits(count, 0);
    for (const auto& [x, y] : points)
      ++hits[static_cast<size_t>(y * rows) * columns + static_cast<size_t>(x * columns)];
    for (const int hit : hits) {
      if (hit != 1) return false;
    }
  }
  return true;
}

std::vector<std::array<Real, 2>> pairs_of(SampleId id, uint32_t pair, uint32_t first, uint32_t count) {
  std::vector<std::array<Real, 2>> points;
  for (id.number = first; id.number < first + count; ++id.number) points.push_back(sample_pair(id, pair));
  return points;
}

// The first points that Joe and Kuo publish, which are in the order of Gray's code.
TEST(SamplesTest, SobolsSequenceIsThePublishedOne) {
  constexpr std::array<std::array<double, 2>, 7> kPoints = {
      {{0.5, 0.5}, {0.75, 0.25}, {0.25, 0.75}, {0.375, 0.375}, {0.875, 0.875}, {0.625, 0.125}, {0.125, 0.625}}};
  for (uint32_t i = 1; i <= kPoints.size(); ++i) {
    for (int dimension = 0; dimension < 2; ++dimension) {
      EXPECT_EQ(sobol(i ^ i >> 1, dimension) * 0x1p-32, kPoints[i - 1][static_cast<size_t>(dimension)]) << i;
    }
  }
}

TEST(SamplesTest, PairsAreNets) {
  for (const SampleId& id :
       {SampleId{}, SampleId{uvec2(639, 17)}, SampleId{uvec2(3, 5), 0, 77}, SampleId{uvec2(9, 4), 0, 3, true}}) {
    for (const uint32_t pair : {0U, 1U, 2U, 17U}) {
      for (uint32_t count = 1; count <= 256; count *= 2) {
        EXPECT_TRUE(are_net(pairs_of(id, pair, 0, count))) << pair << " " << count;
      }
      EXPECT_TRUE(are_net(pairs_of(id, pair, 192, 64))) << "a later batch";
    }
  }
}

/// Returns the RMSE of the part of a light that an edge covers. The edge's place depends on the position in the pixel.
double error_of_edges(bool is_joint, uint32_t count) {
  constexpr uint32_t kEdges = 600;
  double squares = 0.0;
  for (uint32_t edge = 0; edge < kEdges; ++edge) {
    const uvec2 pixel(edge, 31);
    const auto angle = 0.1 * edge;
    const auto covered = [&](uint32_t samples) {
      double sum = 0.0;
      for (uint32_t i = 0; i < samples; ++i) {
        // The position in the pixel: the same dimensions in the order of the samples.
        const auto place = [&](int axis) {
          return scramble(sobol(i, axis), 0x9E3779B9U * (edge + 7 + static_cast<uint32_t>(axis))) * 0x1p-32 - 0.5;
        };
        const auto light = sample_pair({pixel, i, 5, is_joint}, 0);
        const double off = std::cos(angle) * (static_cast<double>(light[0]) - 0.5) +
                           std::sin(angle) * (static_cast<double>(light[1]) - 0.5) +
                           0.3 * (std::cos(3 * angle) * place(0) + std::sin(3 * angle) * place(1));
        sum += off > 0.2 * std::sin(7 * angle) ? 1.0 : 0.0;
      }
      return sum / samples;
    };
    const double off = covered(count) - covered(2048);
    squares += off * off;
  }
  return std::sqrt(squares / kEdges);
}

// The order of the first pair suits the position in the pixel: penumbras have less error than with any other order.
TEST(SamplesTest, TheFirstPairSuitsThePositionsInThePixel) {
  EXPECT_LT(error_of_edges(true, 64), 0.92 * error_of_edges(false, 64));
  EXPECT_LT(error_of_edges(true, 8), 1.05 * error_of_edges(false, 8));
}

// Pixels, pairs and seeds have points of their own.
TEST(SamplesTest, PointsDiffer) {
  const auto first = sample_pair({}, 1);
  EXPECT_NE(sample_pair({uvec2(1, 0)}, 1), first);
  EXPECT_NE(sample_pair({uvec2(0, 1)}, 1), first);
  EXPECT_NE(sample_pair({uvec2(0), 0, 1}, 1), first);
  EXPECT_NE(sample_pair({}, 2), first);
  EXPECT_NE(sample_pair({uvec2(0), 1}, 1), first);
}

// The mean of z over a cone with uniform density is half the sum of 1 and the cosine of its edge, and half of the
// directions are within the cone of half the solid angle.
TEST(SamplesTest, ConesHaveUniformDensity) {
  const Vector axis = glm::normalize(Vector(0.3L, -0.8L, 0.5L));
  for (const Real half_angle : {0.01L, 0.5L, 1.5L, std::numbers::pi_v<Real>}) {
    Vector sum(0);
    for (const auto& point : pairs_of({uvec2(4, 4)}, 1, 0, 4096)) {
      const Vector direction = place_in_cone(axis, half_angle, point);
      EXPECT_NEAR(static_cast<double>(glm::length(direction)), 1.0, 1e-15);
      EXPECT_GE(glm::dot(direction, axis), std::cos(half_angle) - 1e-15L);
      sum += direction / Real(4096);
    }
    const Real expected = (1 + std::cos(half_angle)) / 2;
    EXPECT_NEAR(static_cast<double>(glm::dot(sum, axis) - expected), 0.0, 1e-3 * static_cast<double>(1 - expected));
    EXPECT_NEAR(static_cast<double>(glm::length(sum - glm::dot(sum, axis) * axis)), 0.0, 1e-3);
  }
}

}  // namespace
}  // namespace promin::oracle
