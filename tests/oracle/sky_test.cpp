// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace promin::oracle {
namespace {

constexpr Real kHalfTurn = std::numbers::pi_v<Real>;

Environment make_environment(decltype(Environment::sky) sky) {
  Environment environment;
  environment.sky = std::move(sky);
  return environment;
}

/// Returns a sky that is black at the horizon and below, white at the top, and linear in the elevation.
Environment make_slope() {
  return make_environment(GradientSky{vec3(1.0F), vec3(0.0F), vec3(0.0F), 1.0F, 1.0F});
}

TEST(SurroundingsTest, WithoutASkyAmbientLightComesFromEverywhere) {
  Environment environment;
  environment.ambient = vec3(0.25F, 0.5F, 0.75F);
  const Surroundings surroundings(environment);
  const Vector expected(0.25L, 0.5L, 0.75L);
  EXPECT_EQ(surroundings.radiance({1, 0, 0}), expected);
  EXPECT_EQ(surroundings.irradiance({1, 0, 0}), expected);
  EXPECT_EQ(surroundings.lobe_mean({1, 0, 0}, 0.5L), expected);
  EXPECT_EQ(surroundings.map_error(0.5L), 0);
}

TEST(SurroundingsTest, AConstantSkyIsItsMean) {
  Environment environment = make_environment(GradientSky{vec3(0.5F), vec3(0.5F), vec3(0.5F)});
  environment.intensity = 3.0F;
  const Surroundings surroundings(environment);
  for (const Vector& direction : {Vector(0, 1, 0), Vector(1, 0, 0), glm::normalize(Vector(1, -2, 3))}) {
    EXPECT_NEAR(surroundings.irradiance(direction).x, 1.5L, 1e-6L);
    for (const Real roughness : {0.0L, 0.1L, 0.5L, 1.0L}) {
      EXPECT_NEAR(surroundings.lobe_mean(direction, roughness).x, 1.5L, 1e-9L);
    }
  }
  EXPECT_NEAR(surroundings.range(), 0, 1e-9L);
}

// At roughness 1 the lobe is that of a matt surface: the integral of 2 e / pi sin 2 e over the elevations e is 1/2.
TEST(SurroundingsTest, TheRoughestLobeIsLambert) {
  const Environment environment = make_slope();
  EXPECT_NEAR(Surroundings(environment).lobe_mean({0, 1, 0}, 1).x, 0.5L, 2e-4L);
  EXPECT_NEAR(Surroundings(environment).lobe_mean({0, -1, 0}, 1).x, 0, 1e-12L);
  // The smoothest lobes contain little light from other directions.
  const Vector direction = glm::normalize(Vector(1, 1, 1));
  const Surroundings surroundings(environment);
  EXPECT_NEAR(surroundings.lobe_mean(direction, 0.05L).x, surroundings.radiance(direction).x, 1e-3L);
}

// For wide lobes the test uses another quadrature: over all directions above, with P as in the text.
TEST(SurroundingsTest, LobesAreTheIntegral) {
  const Environment environment = make_environment(Studio{});
  const Surroundings surroundings(environment);
  for (const Real roughness : {0.45L, 0.7L}) {
    const Real alpha2 = std::pow(roughness, Real(4));
    Real sum = 0;
    Real weights = 0;
    for (int i = 0; i < 400; ++i) {
      const Real angle = kHalfTurn / 2 * (i + 0.5L) / 400;
      const Real cosine2 = std::pow(std::cos(angle / 2), Real(2));
      const Real spread = cosine2 * (alpha2 - 1) + 1;
      const Real weight = std::cos(angle) * std::sin(angle) / (spread * spread);
      for (int j = 0; j < 400; ++j) {
        const Real azimuth = 2 * kHalfTurn * (j + 0.5L) / 400;
        const Vector way(std::cos(angle), std::sin(angle) * std::sin(azimuth), std::sin(angle) * std::cos(azimuth));
        sum += weight * surroundings.radiance(way).x;
        weights += weight;
      }
    }
    EXPECT_NEAR(surroundings.lobe_mean({1, 0, 0}, roughness).x, sum / weights, 4e-3L) << roughness;
  }
}

TEST(SurroundingsTest, AGradientGoesFromTheHorizonByItsCurve) {
  const Environment environment = make_environment(GradientSky{vec3(1.0F), vec3(0.0F), vec3(0.5F), 0.5F, 1.0F});
  const Surroundings surroundings(environment);
  EXPECT_NEAR(surroundings.radiance({0, 1, 0}).x, 1, 1e-12L);
  EXPECT_NEAR(surroundings.radiance({1, 0, 0}).x, 0, 1e-12L);
  EXPECT_NEAR(surroundings.radiance({0, -1, 0}).x, 0.5L, 1e-12L);
  // Half way up, the value is 1 - (1 - 1/2)^2.
  EXPECT_NEAR(surroundings.radiance(glm::normalize(Vector(1, 1, 0))).x, 0.75L, 1e-12L);
  EXPECT_NEAR(surroundings.radiance(glm::normalize(Vector(1, -1, 0))).x, 0.25L, 1e-12L);
}

// docs/model.md gives these values for walls in the studio, to two digits; the bands are less exact.
TEST(SurroundingsTest, TheStudioLightsWallsAsItIsDescribed) {
  const Environment environment = make_environment(Studio{});
  const Surroundings surroundings(environment);
  const std::pair<Vector, Real> kWalls[] = {{{0, 0, 1}, 0.36L},  {{0, 1, 0}, 0.56L},  {{1, 0, 0}, 0.36L},
                                            {{-1, 0, 0}, 0.35L}, {{0, 0, -1}, 0.35L}, {{0, -1, 0}, 0.15L}};
  for (const auto& [normal, light] : kWalls) {
    EXPECT_NEAR(surroundings.lobe_mean(normal, 1).x, light, 0.01L);
    EXPECT_NEAR(surroundings.irradiance(normal).x, light, 0.02L);
  }
  // Azimuths count from the viewer to the right: the key light is to the left, at an elevation of 38 degrees.
  const Real elevation = 38 * kHalfTurn / 180;
  const Vector key(-std::sqrt(0.5L) * std::cos(elevation), std::sin(elevation), std::sqrt(0.5L) * std::cos(elevation));
  // In this direction, only the ceiling adds to the key light.
  EXPECT_NEAR(surroundings.radiance(key).x, 0.16L + 1.7L, 1e-9L);
}

TEST(SurroundingsTest, APanoramaHasMinusZInItsMiddleAndTurns) {
  auto image = std::make_shared<Image>();
  image->size = uvec2(4, 1);
  // The pixels are behind to the left, ahead, and to the right: the middles of columns lie between the axes.
  image->pixels = {vec3(1), vec3(2), vec3(3), vec3(4)};
  Environment environment = make_environment(Panorama{image});
  const Real half = std::sqrt(0.5L);
  EXPECT_NEAR(Surroundings(environment).radiance({0, 0, -1}).x, 2.5L, 1e-9L);
  EXPECT_NEAR(Surroundings(environment).radiance({half, 0, -half}).x, 3, 1e-9L);
  EXPECT_NEAR(Surroundings(environment).radiance({1, 0, 0}).x, 3.5L, 1e-9L);
  EXPECT_NEAR(Surroundings(environment).radiance({0, 0, 1}).x, 2.5L, 1e-9L);
  EXPECT_NEAR(Surroundings(environment).radiance({-half, 0, half}).x, 1, 1e-9L);
  // The rotation is from +Z towards +X, so it moves the pixel at -Z to -X.
  environment.rotation = static_cast<float>(kHalfTurn / 2);
  EXPECT_NEAR(Surroundings(environment).radiance({-half, 0, -half}).x, 3, 1e-6L);
  // If +Z is up, the front is -Y: the middle of the picture lies at +Y, and its right is at +X.
  environment.rotation = 0;
  environment.up = vec3(0, 0, 1);
  EXPECT_NEAR(Surroundings(environment).radiance({half, half, 0}).x, 3, 1e-9L);
  EXPECT_NEAR(Surroundings(environment).radiance({-half, -half, 0}).x, 1, 1e-9L);
  // If -Y is up, the front stays and left is right.
  environment.up = vec3(0, -1, 0);
  EXPECT_NEAR(Surroundings(environment).radiance({-half, 0, -half}).x, 3, 1e-9L);
}

}  // namespace
}  // namespace promin::oracle
