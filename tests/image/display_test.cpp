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

#include "image/dither.h"
#include "promin/aovs.h"
#include "promin/image.h"

namespace promin {
namespace {

using Color = std::array<long double, 3>;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// Khronos PBR Neutral as its authors write it, but with a mix to white instead of a saturation.
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

/// Reinhard's curve with a white of 4.
Color reinhard_of(Color c) {
  const long double luminance = 0.2126L * c[0] + 0.7152L * c[1] + 0.0722L * c[2];
  const long double mapped = luminance * (1 + luminance / (4.0L * 4.0L)) / (1 + luminance);
  for (long double& x : c) x = luminance > 0 ? x / luminance * mapped : 0;
  return c;
}

/// AgX as Wrensch writes it.
Color agx_of(Color c) {
  const long double in[3][3] = {{0.842479062253094L, 0.0784335999999992L, 0.0792237451477643L},
                                {0.0423282422610123L, 0.878468636469772L, 0.0791661274605434L},
                                {0.0423756549057051L, 0.0784336L, 0.879142973793104L}};
  const long double out[3][3] = {{1.19687900512017L, -0.0980208811401368L, -0.0990297440797205L},
                                 {-0.0528968517574562L, 1.15190312990417L, -0.0989611768448433L},
                                 {-0.0529716355144438L, -0.0980434501171241L, 1.15107367264116L}};
  const auto times = [](const long double(&m)[3][3], const Color& v) {
    Color r{};
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) r[i] += m[i][j] * v[j];
    }
    return r;
  };
  Color v = times(in, c);
  for (long double& x : v) {
    x = x > 0 ? std::clamp(std::log2(x), -12.47393L, 4.026069L) : -12.47393L;
    x = (x + 12.47393L) / (4.026069L + 12.47393L);
    const long double x2 = x * x;
    const long double x4 = x2 * x2;
    x = 15.5L * x4 * x2 - 40.14L * x4 * x + 31.96L * x4 - 6.868L * x2 * x + 0.4298L * x2 + 0.1191L * x - 0.00232L;
  }
  v = times(out, v);
  for (long double& x : v) x = std::pow(std::max(x, 0.0L), 2.2L);
  return v;
}

/// Returns numbers from black to far beyond white, in steps of 2 %.
std::vector<float> make_ramp() {
  std::vector<float> ramp = {0.0F};
  for (float x = 1e-4F; x < 1e4F; x *= 1.02F) ramp.push_back(x);
  return ramp;
}

vec3 apply(ToneMapping mapping, const vec3& radiance) {
  return promin::apply({.tone_mapping = mapping}, radiance);
}

TEST(DisplayTest, TheDefaultKeepsEveryBit) {
  for (const float x : {0.0F, -1.0F, 1e-40F, 0.18F, 1.0F, 3e38F, kInfinite}) {
    EXPECT_EQ(promin::apply({}, vec3(x, 0.5F, -x)), vec3(x, 0.5F, -x));
  }
}

TEST(DisplayTest, ExposureCountsInStops) {
  EXPECT_EQ(promin::apply({.exposure_ev = 1.0F}, vec3(0.25F, 0.5F, 3.0F)), vec3(0.5F, 1.0F, 6.0F));
  EXPECT_EQ(promin::apply({.exposure_ev = -3.0F}, vec3(8.0F, 0.5F, 0.0F)), vec3(1.0F, 0.0625F, 0.0F));
  EXPECT_NEAR(promin::apply({.exposure_ev = 0.5F}, vec3(1.0F)).x, std::sqrt(2.0), 1e-7);
  // The exposure is applied before the curve.
  EXPECT_EQ(promin::apply({.exposure_ev = 2.0F, .tone_mapping = ToneMapping::kNeutral}, vec3(0.5F)),
            apply(ToneMapping::kNeutral, vec3(2.0F)));
}

TEST(DisplayTest, UnlitLightIsShownAsItIs) {
  const DisplayTransform display{.exposure_ev = 3.0F, .tone_mapping = ToneMapping::kAces};
  const vec3 lit(0.5F, 0.1F, 2.0F);
  const vec3 unlit(0.25F, 0.75F, 0.5F);
  EXPECT_EQ(promin::apply(display, lit, vec4(0.0F)), promin::apply(display, lit));
  EXPECT_EQ(promin::apply(display, unlit, vec4(unlit, 1.0F)), unlit);
  // A pixel that both surfaces cover shows both in proportion to their fractions, and is not brighter than the brighter
  // surface.
  for (const float share : {0.25F, 0.5F, 0.75F}) {
    const vec3 shown = promin::apply(display, share * unlit + (1.0F - share) * lit, vec4(share * unlit, share));
    const vec3 expected = share * unlit + (1.0F - share) * promin::apply(display, lit);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(shown[i], expected[i], 1e-6F) << share;
  }
  EXPECT_EQ(promin::apply({}, lit, vec4(0.1F, 0.1F, 0.1F, 0.5F)), lit);
  // Rounding may make the lit light slightly negative.
  const vec3 rounded = promin::apply(display, unlit * (1.0F - 1e-6F), vec4(unlit, 1.0F - 1e-7F));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(rounded[i], unlit[i], 1e-6F);
}

TEST(DisplayTest, UnlitSurfacesDoNotTellTheExposure) {
  const std::vector<vec3> pixels = {vec3(0.5F), vec3(0.01F), vec3(0.3F)};
  const std::vector<vec4> unlit = {vec4(0.0F), vec4(0.01F, 0.01F, 0.01F, 1.0F), vec4(0.05F, 0.05F, 0.05F, 0.5F)};
  EXPECT_FLOAT_EQ(average_exposure_ev(pixels, {}, unlit), average_exposure_ev(std::vector{vec3(0.5F)}, {}));
  EXPECT_EQ(average_exposure_ev({&pixels[1], 1}, {}, {&unlit[1], 1}), 0.0F);
}

TEST(DisplayTest, TheCurvesAreThoseOfTheirAuthors) {
  const std::pair<ToneMapping, Color (*)(Color)> curves[] = {{ToneMapping::kNeutral, neutral_of},
                                                             {ToneMapping::kAces, aces_of},
                                                             {ToneMapping::kReinhard, reinhard_of},
                                                             {ToneMapping::kAgx, agx_of}};
  for (const auto& [mapping, curve] : curves) {
    for (const vec3& tint : {vec3(1), vec3(1, 0.5F, 0.02F), vec3(0, 0.3F, 1), vec3(0.9F, 1, 0.95F)}) {
      for (const float x : make_ramp()) {
        const vec3 radiance = x * tint;
        const vec3 shown = apply(mapping, radiance);
        const Color expected = curve({radiance.x, radiance.y, radiance.z});
        for (int i = 0; i < 3; ++i) {
          ASSERT_NEAR(shown[i], static_cast<double>(expected[static_cast<size_t>(i)]),
                      1.2e-7 * std::max(1.0, static_cast<double>(shown[i])))
              << x << " " << i;
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
  // The light is that of a surface of this colour under E = pi, plus the fraction 0.04 that the surface reflects.
  for (const vec3& base : {vec3(0.05F), vec3(0.76F, 0.1F, 0.3F), vec3(0.5F, 0.7F, 0.04F)}) {
    const vec3 shown = apply(ToneMapping::kNeutral, base + 0.04F);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(shown[i], base[i], 1e-7) << base[i];
  }
  // The background of scenes without one is the grey of Khronos' screenshots.
  EXPECT_EQ(std::lround(255.0F * encode_srgb(apply(ToneMapping::kNeutral, vec3(0.25F)).x)), 126);
}

TEST(DisplayTest, WhatIsNoColorIsShownAsOne) {
  for (const ToneMapping mapping :
       {ToneMapping::kNeutral, ToneMapping::kAces, ToneMapping::kReinhard, ToneMapping::kAgx}) {
    for (const float x : {kInfinite, 3e38F, -kInfinite, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
      const vec3 shown = promin::apply({.exposure_ev = 60.0F, .tone_mapping = mapping}, vec3(x, 0.5F, x));
      // Reinhard's curve continues beyond its white.
      const float most = mapping == ToneMapping::kReinhard ? 1e9F : 1.04F;
      for (int i = 0; i < 3; ++i) EXPECT_TRUE(shown[i] >= 0.0F && shown[i] < most) << x << " " << shown[i];
    }
    EXPECT_EQ(apply(mapping, vec3(-1.0F)), vec3(0.0F));
  }
}

TEST(DisplayTest, TheAverageExposureBringsTheLogMeanToMiddleGrey) {
  const std::vector<vec3> pixels = {vec3(0.09F), vec3(0.36F), vec3(5.0F), vec3(kInfinite)};
  const std::vector<uint32_t> objects = {0, 7, Aovs::kNoId, 1};
  EXPECT_NEAR(average_exposure_ev(pixels, objects), 0.0, 2e-3) << "sky and what is not finite do not count";
  const double mean = (std::log(0.09) + std::log(0.36) + std::log(5.0)) / 3;
  EXPECT_NEAR(average_exposure_ev(pixels, {}), std::log2(0.18 / std::exp(mean)), 1e-3);
  EXPECT_EQ(average_exposure_ev(std::vector<vec3>{vec3(kInfinite)}, {}), 0.0F);
  EXPECT_NEAR(average_exposure_ev(std::vector<vec3>{vec3(0.0F)}, {}), std::log2(1800.0), 1e-5) << "black is not lost";
}

// For a flat grey between two codes, the mean of the codes is the grey, and no pixel differs by more than one and a
// half codes.
TEST(DisplayTest, DitheringKeepsTheMeanAndBlackAndWhite) {
  for (const double code : {0.0, 0.25, 17.5, 100.75, 254.6, 255.0}) {
    double sum = 0.0;
    double squares = 0.0;
    constexpr uint32_t kSide = 200;
    for (uint32_t y = 0; y < kSide; ++y) {
      for (uint32_t x = 0; x < kSide; ++x) {
        const double shown = std::lround(dithered(static_cast<float>(code), x, y, 1));
        EXPECT_LE(std::abs(shown - code), 1.5);
        sum += shown;
        squares += (shown - code) * (shown - code);
      }
    }
    const double count = kSide * kSide;
    EXPECT_NEAR(sum / count, code, 0.02) << code;
    if (code == 17.5 || code == 100.75) {
      EXPECT_NEAR(squares / count, 0.25, 0.01) << "of the noise and of rounding";
    }
    if (code == 0.0 || code == 255.0) {
      EXPECT_EQ(squares, 0.0);
    }
  }
  EXPECT_NE(dithered(10.5F, 3, 4, 0), dithered(10.5F, 4, 3, 0));
  EXPECT_NE(dithered(10.5F, 3, 4, 0), dithered(10.5F, 3, 4, 2)) << "channels apart";
}

TEST(DisplayTest, NamesGoByTheirNumbers) {
  EXPECT_THAT(tone_mapping_names(), testing::ElementsAre("none", "neutral", "aces", "reinhard", "agx"));
}

}  // namespace
}  // namespace promin
