// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/alpha_coverage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace promin {
namespace {

using testing::ElementsAre;

std::vector<uint32_t> texels_of(const std::vector<uint32_t>& alphas) {
  std::vector<uint32_t> texels;
  for (const uint32_t alpha : alphas) texels.push_back(0x00123456 | alpha << 24);
  return texels;
}

std::vector<uint32_t> scaled(const std::vector<uint32_t>& alphas, float cutoff, double coverage) {
  std::vector<uint32_t> texels = texels_of(alphas);
  scale_alpha_to_coverage(texels, cutoff, coverage);
  std::vector<uint32_t> result;
  for (const uint32_t texel : texels) {
    EXPECT_EQ(texel & 0x00FFFFFF, 0x00123456U) << "colours stay";
    result.push_back(texel >> 24);
  }
  return result;
}

TEST(AlphaCoverage, IsTheShareFromTheCutoffOn) {
  EXPECT_EQ(alpha_coverage(texels_of({0, 127, 128, 255}), 0.5F), 0.5) << "127 / 255 is less than a half";
  EXPECT_EQ(alpha_coverage(texels_of({0, 51, 52, 50}), 0.2F), 0.5);
  EXPECT_EQ(alpha_coverage(texels_of({0, 255}), 0.0F), 1.0);
  EXPECT_EQ(alpha_coverage(texels_of({0, 255}), 1.0F), 0.5);
  EXPECT_EQ(alpha_coverage(texels_of({0, 255}), 1.5F), 0.0);
  EXPECT_EQ(alpha_coverage({}, 0.5F), 0.0);
}

TEST(AlphaCoverage, AlphasAreScaledToTheCutoff) {
  // Half of the texels must be above the cutoff: 60 becomes 128, and all others are scaled by the same factor.
  EXPECT_THAT(scaled({10, 30, 60, 90}, 0.5F, 0.5), ElementsAre(21U, 64U, 128U, 192U));
  EXPECT_THAT(scaled({200, 210, 220, 230}, 0.5F, 0.25), ElementsAre(116U, 122U, 127U, 133U)) << "down, too";
  EXPECT_THAT(scaled({10, 30, 200, 250}, 0.5F, 0.5), ElementsAre(10U, 30U, 200U, 250U)) << "nothing to do";
  EXPECT_THAT(scaled({100, 200}, 0.5F, 1.0), ElementsAre(100U, 200U));
  EXPECT_THAT(scaled({100, 200}, 0.5F, 0.0), ElementsAre(100U, 200U));
  EXPECT_THAT(scaled({199, 200}, 0.2F, 0.5), ElementsAre(50U, 51U)) << "rounding carries none over the cutoff";
  EXPECT_THAT(scaled({1, 2, 0, 0}, 1.0F, 0.5), ElementsAre(255U, 255U, 0U, 0U));
}

/// A net of thin wires fades below the cutoff in levels of plain means; here it keeps its fraction.
TEST(AlphaCoverage, LevelsKeepIt) {
  std::mt19937 random(3);
  constexpr double kCoverage = 0.2;
  std::vector<double> alphas(256 * 256);
  for (double& alpha : alphas) alpha = random() % 1000 < 1000 * kCoverage ? 255.0 : 0.0;
  for (size_t side = 128; side >= 8; side /= 2) {
    std::vector<double> next(side * side);
    for (size_t i = 0; i < next.size(); ++i) {
      const size_t at = 4 * side * (i / side) + 2 * (i % side);
      next[i] = (alphas[at] + alphas[at + 1] + alphas[at + 2 * side] + alphas[at + 2 * side + 1]) / 4;
    }
    alphas = next;
    if (side > 32) continue;
    std::vector<uint32_t> texels;
    for (const double alpha : alphas) texels.push_back(static_cast<uint32_t>(std::lround(alpha)) << 24);
    EXPECT_LT(alpha_coverage(texels, 0.5F), 0.02) << "means alone thin it out";
    scale_alpha_to_coverage(texels, 0.5F, kCoverage);
    EXPECT_NEAR(alpha_coverage(texels, 0.5F), kCoverage, 0.04) << side;
  }
}

}  // namespace
}  // namespace promin
