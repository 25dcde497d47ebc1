// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "promin/image.h"

namespace promin {
namespace {

using Color = std::array<long double, 3>;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Khronos PBR Neutral as its authors write it, with a mix to white instead of a saturation.
Color neutral_of(Color c) {
  const long double start = 0.8L - 0.04L;
  const long double least = std::min({c[0], c[1], c[2]});
  const long double offset = least < 0.08L ? least - 6.25L * least * least : 0.04L;
  for (long double& x : c) x -= offset;
  const long double peak = std::max({c[0], c[1], c[2]});
  if (peak < start) return c;
  const long double d = 1.0L - start;
  const long double new_peak = 1.0L - d * d / (peak + d - start);
  const long double whitened = 1.0L - 1.0L / (0.15L * (peak - new_peak) + 1.0L);
  for (long double& x : c) x = (1.0L - whitened) * (x * new_peak / peak) + whitened * new_peak;
  return c;
}

Color aces_of(Color c) {
  for (long double& x : c) x = (x * (2.51L * x + 0.03L)) / (x * (2.43L * x + 0.59L) + 0.14L);
  return c;
}

/// From black to far beyond white, in steps of 2 %.
std::vector<float> make_ramp() {
  std::vector<float> ramp = {0.0F};
  for (float x = 1e-4F; x < 1e4F; x *= 1.02F) ramp.push_back(x);
  return ramp;
}

vec3 apply(ToneMapping mapping, const vec3& radiance) {
  return promin::apply({.tone_mapping = mapping}, radiance);
}

TEST(DisplayTest, TheDefaultKeepsEveryBit) {
  for (const float x : {0.0F, -1.0F, 1e-40F, 0.18F, 1.0F, 3e38F, kInfinity}) {
    EXPECT_EQ(promin::apply({}, vec3(x, 0.5F, -x)), vec3(x, 0.5F, -x));
  }
}

TEST(DisplayTest, ExposureCountsInStops) {
  EXPECT_EQ(promin::apply({.exposure_ev = 1.0F}, vec3(0.25F, 0.5F, 3.0F)), vec3(0.5F, 1.0F, 6.0F));
  EXPECT_EQ(promin::apply({.exposure_ev = -3.0F}, vec3(8.0F, 0.5F, 0.0F)), vec3(1.0F, 0.0625F, 0.0F));
  EXPECT_NEAR(promin::apply({.exposure_ev = 0.5F}, vec3(1.0F)).x, std::sqrt(2.0), 1e-7);
  // The exposure comes before the curve.
  EXPECT_EQ(promin::apply({.exposure_ev = 2.0F, .tone_mapping = ToneMapping::kNeutral}, vec3(0.5F)),
            apply(ToneMapping::kNeutral, vec3(2.0F)));
}

TEST(DisplayTest, TheCurvesAreThoseOfTheirAuthors) {
  const std::pair<ToneMapping, Color (*)(Color)> curves[] = {{ToneMapping::kNeutral, neutral_of},
                                                             {ToneMapping::kAces, aces_of}};
  for (const auto& [mapping, curve] : curves) {
    for (const vec3& tint : {vec3(1), vec3(1, 0.5F, 0.02F), vec3(0, 0.3F, 1), vec3(0.9F, 1, 0.95F)}) {
      for (const float x : make_ramp()) {
        const vec3 radiance = x * tint;
        const vec3 shown = apply(mapping, radiance);
        const Color expected = curve({radiance.x, radiance.y, radiance.z});
        for (int i = 0; i < 3; ++i) {
          ASSERT_NEAR(shown[i], static_cast<double>(expected[static_cast<size_t>(i)]), 1.2e-7) << x << " " << i;
        }
      }
    }
  }
}

TEST(DisplayTest, NeutralIsMonotoneAndKeepsGreyGreyAndBelowWhite) {
  float last = -1.0F;
  for (const float x : make_ramp()) {
    const vec3 shown = apply(ToneMapping::kNeutral, vec3(x));
    EXPECT_EQ(shown, vec3(shown.x));
    EXPECT_TRUE(shown.x > last || shown.x > 0.999F) << x;
    EXPECT_LT(shown.x, 1.0F + 1e-7F) << x;
    last = shown.x;
  }
  EXPECT_GT(last, 0.9999F);
}

TEST(DisplayTest, NeutralKeepsBaseColorsBelowItsShoulder) {
  // What a surface of this colour sends under E = pi, with the 0.04 that it reflects beside.
  for (const vec3& base : {vec3(0.05F), vec3(0.76F, 0.1F, 0.3F), vec3(0.5F, 0.7F, 0.04F)}) {
    const vec3 shown = apply(ToneMapping::kNeutral, base + 0.04F);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(shown[i], base[i], 1e-7) << base[i];
  }
  // The background of scenes without one is the grey of Khronos' screenshots.
  EXPECT_EQ(std::lround(255.0F * encode_srgb(apply(ToneMapping::kNeutral, vec3(0.25F)).x)), 126);
}

TEST(DisplayTest, WhatIsNoColorIsShownAsOne) {
  for (const ToneMapping mapping : {ToneMapping::kNeutral, ToneMapping::kAces}) {
    for (const float x : {kInfinity, 3e38F, -kInfinity, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
      const vec3 shown = promin::apply({.exposure_ev = 60.0F, .tone_mapping = mapping}, vec3(x, 0.5F, x));
      for (int i = 0; i < 3; ++i) EXPECT_TRUE(shown[i] >= 0.0F && shown[i] < 1.04F) << x << " " << shown[i];
    }
    EXPECT_EQ(apply(mapping, vec3(-1.0F)), vec3(0.0F));
  }
}

TEST(DisplayTest, NamesGoByTheirNumbers) {
  EXPECT_THAT(tone_mapping_names(), testing::ElementsAre("none", "neutral", "aces"));
}

}  // namespace
}  // namespace promin
