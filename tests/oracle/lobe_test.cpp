// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/lobe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "shared/layout.h"

namespace promin::oracle {
namespace {

constexpr Real kRealPi = std::numbers::pi_v<Real>;
constexpr size_t kSide = layout::LOBE_TABLE_SIDE;
constexpr Real kLast = kSide - 1;

/// Returns the direction with this cosine to the normal and this azimuth.
Vector direction_at(Real cosine, Real azimuth) {
  const Real sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

const Vector kUp(0, 0, 1);

MetallicRoughness make_white(float metallic, float roughness) {
  MetallicRoughness material;
  material.metallic = metallic;
  material.roughness = roughness;
  return material;
}

/// Returns the larger of the two members' differences.
Real difference(const LobeShares& a, const LobeShares& b) {
  return std::max(std::abs(a.all - b.all), std::abs(a.grazing - b.grazing));
}

// The projected area of all facets is 1: the integral of D (N.H) over the hemisphere.
TEST(OracleLobe, DensitiesAreOfAWholeSurface) {
  for (const Real alpha : {0.002L, 0.03L, 0.3L, 1.0L}) {
    constexpr int kSteps = 20000;
    Real sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      // The tangents of the angle grow geometrically, from far inside the lobe to near the horizon.
      const Real first = std::log(alpha * 1e-4L);
      const Real step = (std::log(1e4L) - first) / kSteps;
      const Real tangent = std::exp(first + (i + 0.5L) * step);
      const Real theta = std::atan(tangent);
      const Real d_theta = tangent / (1 + tangent * tangent) * step;
      sum += 2 * kRealPi * std::sin(theta) * std::cos(theta) * microfacet_density(theta, alpha) * d_theta;
    }
    EXPECT_NEAR(static_cast<double>(sum), 1.0, 1e-6) << static_cast<double>(alpha);
  }
}

// A perfectly smooth surface has no masking at any angle. A rough surface has none when seen from above.
TEST(OracleLobe, VisibilityIsOneOverFourCosinesWhereNothingIsHidden) {
  EXPECT_NEAR(static_cast<double>(visibility(0.5L, 0.25L, 0)), 2.0, 1e-15);
  EXPECT_NEAR(static_cast<double>(visibility(1, 1, 0.7L)), 0.25, 1e-15);
  EXPECT_LT(visibility(0.5L, 0.25L, 0.5L), 2);
}

// Eye and light may be exchanged, except for the cosine to the light, which every source has, and for the factor of
// light that facets reflect more than once, which depends only on the eye and is 1 here.
TEST(OracleLobe, TheLobeIsReciprocal) {
  MetallicRoughness material = make_white(0.5F, 0);
  material.base_color = vec3(0.9F, 0.5F, 0.1F);
  for (const float roughness : {0.0F, 0.1F, 0.5F, 1.0F}) {
    material.roughness = roughness;
    const Lobe lobe(material, Vector(1), LobeShares());
    for (int i = 0; i < 50; ++i) {
      const Vector a = direction_at(0.02L + 0.0195L * i, 0);
      const Vector b = direction_at(0.99L - 0.017L * i, 0.06L * i);
      const LobeAngles there = angles_of(kUp, a, b);
      const LobeAngles back = angles_of(kUp, b, a);
      const Vector ratio = lobe.highlight(there) * back.l / (lobe.highlight(back) * there.l);
      EXPECT_LE(glm::distance(ratio, Vector(1)), 1e-12L) << roughness << " " << i;
    }
  }
}

// The test compares the table with another quadrature. It uses Gaussian quadrature over directions to the light instead
// of a lattice of half vectors sampled by their density.
TEST(OracleLobe, TheTablesEntriesAreTheIntegrals) {
  std::array<std::array<Real, kSide>, kSide> errors{};
  for_each_index(kSide, 0, [&](size_t row) {
    for (size_t column = 0; column < kSide; ++column) {
      const Real v = (column / kLast) * (column / kLast);
      errors[row][column] = difference(look_up_lobe_shares(v, row / kLast), integrate_lobe_shares(v, row / kLast));
    }
  });
  for (size_t row = 0; row < kSide; ++row) {
    for (size_t column = 0; column < kSide; ++column) {
      EXPECT_LE(errors[row][column], 0.0003L) << "column " << column << " row " << row;
    }
  }
}

// The light of sources from all directions adds up to one on a white surface. Lobes are linear in F0 and F90, so the
// sums over all sources are the exact values that the table approximates.
TEST(OracleLobe, SourcesFromEverywhereAddUpToOne) {
  std::array<Real, 11> worst{};
  for_each_index(worst.size(), 0, [&](size_t i) {
    for (size_t k = 0; k < 16; ++k) {
      const Real v = (k + 0.5L) / 16;
      const Real roughness = i / 10.0L;
      const LobeShares table = look_up_lobe_shares(v, roughness);
      for (const float metallic : {0.0F, 0.5F, 1.0F}) {
        const Lobe lobe(make_white(metallic, static_cast<float>(roughness)), Vector(1), table);
        const LobeShares exact = integrate_lobe_shares(v, std::sqrt(lobe.alpha_of_sources()));
        const Real one = lobe.albedo().x + lobe.highlights_of_all(exact).x;
        worst[i] = std::max(worst[i], std::abs(one - 1));
      }
    }
  });
  for (size_t i = 0; i < worst.size(); ++i) EXPECT_LE(worst[i], 0.01L) << "roughness 0." << i;
}

// The test checks positions between entries: the middle of each cell and of its edges. Seen from the side, a smooth
// lobe depends on v / alpha, which no table over v resolves. There the error is up to 0.081, in a rim of v < 0.05 on
// surfaces with a roughness of less than 0.06.
TEST(OracleLobe, TheTableIsGoodBetweenItsEntries) {
  constexpr size_t kPlaces = 2 * kSide - 1;
  struct Worst {
    Real steep = 0;
    Real grazing = 0;
  };
  std::array<Worst, kPlaces> worst{};
  for_each_index(kPlaces, 0, [&](size_t row) {
    for (size_t column = 0; column < kPlaces; ++column) {
      if (row % 2 == 0 && column % 2 == 0) continue;
      const Real root = column / (2 * kLast);
      const Real roughness = row / (2 * kLast);
      const Real v = root * root;
      const Real error = difference(look_up_lobe_shares(v, roughness), integrate_lobe_shares(v, roughness));
      Real& largest = v > 0.05L ? worst[row].steep : worst[row].grazing;
      largest = std::max(largest, error);
    }
  });
  for (size_t row = 0; row < kPlaces; ++row) {
    const Real roughness = row / (2 * kLast);
    EXPECT_LE(worst[row].steep, 0.005L) << "roughness " << static_cast<double>(roughness);
    EXPECT_LE(worst[row].grazing, roughness < 0.06L ? 0.081L : 0.025L)
        << "roughness " << static_cast<double>(roughness);
  }
}

// The same holds for sheens. Seen from the side, a smooth sheen changes faster than the table's steps: between entries
// the error is up to 0.033 of up to 1.65.
TEST(OracleLobe, TheTableOfSheensIsTheIntegral) {
  constexpr size_t kPlaces = 2 * kSide - 1;
  struct Worst {
    Real at_entries = 0;
    Real smooth = 0;
    Real rough = 0;
  };
  std::array<Worst, kPlaces> worst{};
  for_each_index(kPlaces, 0, [&](size_t row) {
    for (size_t column = 0; column < kPlaces; ++column) {
      const Real root = column / (2 * kLast);
      const Real roughness = row / (2 * kLast);
      const Real v = std::max(root * root, 0x1p-10L);
      const Real error = std::abs(look_up_sheen_share(v, roughness) - integrate_sheen_share(v, roughness));
      // The first column is for the least cosine, which lies between this column and the next.
      const bool is_entry = row % 2 == 0 && column % 2 == 0 && column > 0;
      Real& largest = is_entry ? worst[row].at_entries : roughness < 0.1L ? worst[row].smooth : worst[row].rough;
      largest = std::max(largest, error);
    }
  });
  for (size_t row = 0; row < kPlaces; ++row) {
    EXPECT_LE(worst[row].at_entries, 0.0003L) << row;
    EXPECT_LE(worst[row].smooth, 0.05L) << row;
    EXPECT_LE(worst[row].rough, 0.012L) << row;
  }
}

// A sheen over white reflects all light from all directions, because the layers below receive the light that the sheen
// does not reflect.
TEST(OracleLobe, WhiteSheensOverWhiteSendWhatTheyGet) {
  MetallicRoughness material = make_white(0, 0.5F);
  material.sheen_color = vec3(1.0F);
  for (const float roughness : {0.0F, 0.3F, 1.0F}) {
    material.sheen_roughness = roughness;
    for (const Real v : {0x1p-10L, 0.01L, 0.3L, 1.0L}) {
      const Sheen sheen(material, v);
      const Real sum = sheen.reflectance().x + sheen.left();
      EXPECT_NEAR(static_cast<double>(sum), 1.0, 1e-15) << roughness;
      EXPECT_GE(sheen.left(), 0) << roughness;
    }
  }
}

}  // namespace
}  // namespace promin::oracle
