// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "promin/image.h"
#include "support/thorough.h"

namespace promin {
namespace {

/// Returns the color at a position of the picture, in pixels.
using Scene = std::function<vec3(const dvec2&)>;

/// The result for a window of a picture, row by row.
struct Refined {
  std::vector<vec3> means;
  std::vector<vec3> claims;
  std::vector<uint32_t> counts;
  std::vector<bool> are_near_enough;
  uint64_t samples = 0;
};

View make_refined_view(float error, uint32_t least = 8, uint32_t most = 256) {
  View view;
  view.size = uvec2(96, 64);
  view.error_target = {.error = error, .min_samples = least, .max_samples = most};
  return view;
}

void run(Refinement& refinement, const Scene& scene, size_t most_at_once) {
  std::vector<vec3> seen;
  for (auto list = refinement.next(most_at_once); !list.empty(); list = refinement.next(most_at_once)) {
    seen.clear();
    for (const ListedSample& sample : list) seen.push_back(scene(dvec2(sample.pixel) + dvec2(sample.place)));
    refinement.take(seen);
  }
}

Refined results_of(const Refinement& refinement) {
  Refined refined;
  for (size_t i = 0; i < refinement.pixel_count(); ++i) {
    refined.means.push_back(refinement.estimate(i).mean());
    refined.claims.push_back(refinement.claim(i));
    refined.counts.push_back(refinement.estimate(i).count());
    refined.are_near_enough.push_back(refinement.is_near_enough(i));
  }
  refined.samples = refinement.sample_count();
  return refined;
}

Refined refine(const View& view, const Scene& scene, const PixelWindow& window, size_t most_at_once = 5000) {
  Refinement refinement(view, window);
  run(refinement, scene, most_at_once);
  return results_of(refinement);
}

Refined refine(const View& view, const Scene& scene) {
  return refine(view, scene, {uvec2(0), view.size});
}

/// Returns the color of discs of any size and brightness in front of a chequered floor that extends to the horizon.
vec3 discs_and_floor(const dvec2& p) {
  vec3 color(0.1F, 0.2F, 0.4F);
  if (p.y > 20.0) {
    const double depth = 300.0 / (p.y - 20.0);
    const auto square =
        static_cast<int64_t>(std::floor(depth)) + static_cast<int64_t>(std::floor((p.x - 48.0) * depth * 0.02));
    color = (square & 1) != 0 ? vec3(0.9F) : vec3(0.15F, 0.1F, 0.1F);
  }
  for (int i = 0; i < 24; ++i) {
    const dvec2 center(std::fmod(37.0 * i + 5.3, 96.0), std::fmod(23.0 * i + 9.7, 64.0));
    const double radius = 0.7 + 0.4 * i;
    const dvec2 off = p - center;
    const double d2 = glm::dot(off, off) / (radius * radius);
    // The discs are shaded, with a highlight.
    if (d2 < 1.0) {
      const auto z = static_cast<float>(std::sqrt(1.0 - d2));
      color = vec3(0.2F + 0.6F * z, 0.04F * static_cast<float>(i), 0.5F * z) + vec3(4.0F * std::pow(z, 60.0F));
    }
  }
  return color;
}

/// Returns the color of lines of 1/8 to 1.5 pixels, at all angles.
vec3 wires(const dvec2& p) {
  for (int i = 0; i < 14; ++i) {
    const double angle = 0.11 + 0.22 * i;
    const dvec2 normal(std::cos(angle), std::sin(angle));
    const double off = glm::dot(p - dvec2(48.0 + i, 32.0 - i), normal);
    const double half_width = 0.0625 + 0.05 * i;
    if (std::abs(off - (6.0 * i - 40.0)) < half_width) return vec3(0.9F, 0.5F, 0.1F);
  }
  return vec3(0.05F);
}

/// Returns the color of smooth waves and a step.
vec3 waves(const dvec2& p) {
  const double wave = 0.5 + 0.5 * std::sin(1.3 * p.x) * std::cos(0.9 * p.y);
  return vec3(static_cast<float>(wave), p.x * 0.83 + p.y < 70.0 ? 1.0F : 0.0F, static_cast<float>(wave * wave));
}

struct Share {
  double honest = 0.0;
  size_t refined = 0;
};

/// Returns the true pixels of a view, as means over a grid of many samples.
std::vector<dvec3> find_truth(const View& view, const Scene& scene) {
  constexpr int kSide = 48;
  std::vector<dvec3> truth;
  for (uint32_t i = 0; i < view.size.x * view.size.y; ++i) {
    dvec3 sum(0.0);
    for (int k = 0; k < kSide * kSide; ++k) {
      const dvec2 place((k % kSide + 0.5) / kSide, (k / kSide + 0.5) / kSide);
      sum += dvec3(scene(dvec2(i % view.size.x, i / view.size.x) + place));
    }
    truth.push_back(sum / double{kSide * kSide});
  }
  return truth;
}

/// Returns how many of the refined pixels, which have more than the first samples, have an error within their claim.
Share judge_claims(const Refined& refined, const View& view, const std::vector<dvec3>& truth) {
  Share share;
  size_t honest = 0;
  for (size_t i = 0; i < refined.means.size(); ++i) {
    if (refined.counts[i] == view.error_target->min_samples) continue;
    ++share.refined;
    const dvec3 error = glm::abs(dvec3(refined.means[i]) - truth[i]);
    const dvec3 claim(refined.claims[i]);
    if (error.x <= claim.x && error.y <= claim.y && error.z <= claim.z) ++honest;
  }
  share.honest = static_cast<double>(honest) / static_cast<double>(share.refined);
  return share;
}

TEST(RefinementTest, ClaimsHoldOf95In100Pixels) {
  const std::pair<const char*, Scene> scenes[] = {
      {"discs and floor", discs_and_floor}, {"wires", wires}, {"waves", waves}};
  for (const auto& [name, scene] : scenes) {
    const std::vector<dvec3> truth = find_truth(make_refined_view(1.0F), scene);
    for (const auto& [error, least_samples] : test::cases_of<std::pair<float, uint32_t>>(
             {{1.0F / 16.0F, 4U}, {1.0F / 64.0F, 8U}, {1.0F / 16.0F, 8U}, {1.0F / 128.0F, 8U}}, 2)) {
      const View view = make_refined_view(error, least_samples);
      const Share share = judge_claims(refine(view, scene), view, truth);
      std::printf("%-16s 1/%-3g from %u: %5zu pixels refined, %.2f %% honest\n", name, 1.0 / static_cast<double>(error),
                  least_samples, share.refined, 100.0 * share.honest);
      EXPECT_GE(share.honest, 0.95) << name << " to " << error << " from " << least_samples;
      EXPECT_GE(share.refined, 500U) << name;
    }
  }
}

/// Returns the fraction of the pixels on lines of this width and a contrast of 0.8 whose final error is too
/// large.
double share_missed(double width, uint32_t least_samples) {
  size_t missed = 0;
  size_t pixels = 0;
  for (int i = 0; i < 24; ++i) {
    const double angle = 0.07 + std::numbers::pi * i / 24.0;
    const dvec2 normal(std::cos(angle), std::sin(angle));
    const auto line = [&](const dvec2& p) {
      return vec3(std::abs(glm::dot(p - dvec2(48.3, 32.1), normal)) < 0.5 * width ? 0.8F : 0.0F);
    };
    const View view = make_refined_view(1.0F / 64.0F, least_samples);
    const Refined refined = refine(view, line);
    for (size_t pixel = 0; pixel < refined.means.size(); ++pixel) {
      const dvec2 corner(pixel % view.size.x, pixel / view.size.x);
      constexpr int kSteps = 64;
      double covered = 0.0;
      for (int k = 0; k < kSteps * kSteps; ++k) {
        const dvec2 place((k % kSteps + 0.5) / kSteps, (k / kSteps + 0.5) / kSteps);
        if (k == 0 && std::abs(glm::dot(corner + 0.5 - dvec2(48.3, 32.1), normal)) > 0.8 + width) break;
        covered += static_cast<double>(line(corner + place).x);
      }
      const double truth = covered / (kSteps * kSteps);
      if (truth <= 0.0) continue;
      ++pixels;
      missed += std::abs(static_cast<double>(refined.means[pixel].x) - truth) > 1.0 / 64.0 ? 1 : 0;
    }
  }
  return static_cast<double>(missed) / static_cast<double>(pixels);
}

// The manual says this about lines that are thinner than a pixel divided by the number of first samples. Possibly no
// sample of a pixel and its neighbours hits them.
TEST(RefinementTest, ThinLinesMayLieBetweenAllSamples) {
  for (const uint32_t samples : {4U, 8U, 16U}) {
    std::printf("%u first samples:", samples);
    for (const double width : {1.0 / 4.0, 1.0 / 8.0, 1.0 / 16.0, 1.0 / 32.0}) {
      const double missed = share_missed(width, samples);
      std::printf(" 1/%g pixel %.1f %%", 1.0 / width, 100.0 * missed);
      const double samples_across = width * samples;
      EXPECT_LT(missed, samples_across >= 2.0 ? 0.04 : samples_across >= 1.0 ? 0.08 : 1.0) << width;
      EXPECT_GT(missed, samples_across <= 0.25 ? 0.3 : 0.0) << width;
    }
    std::printf("\n");
  }
}

TEST(RefinementTest, APixelStopsWhereItsClaimIsSmallEnough) {
  const View view = make_refined_view(1.0F / 64.0F);
  const Refined refined = refine(view, discs_and_floor);
  size_t unmet = 0;
  for (size_t i = 0; i < refined.means.size(); ++i) {
    const float claim = claimed_error(refined.claims[i], refined.means[i], ErrorTarget{});
    EXPECT_EQ(refined.are_near_enough[i], claim <= 1.0F / 64.0F);
    if (claim > 1.0F / 64.0F) {
      EXPECT_EQ(refined.counts[i], 256U);
      ++unmet;
    }
  }
  EXPECT_GT(unmet, 0U);
  EXPECT_LT(unmet, refined.means.size() / 4);
}

// A picture with a positive exposure is refined as if its light were brighter.
TEST(RefinementTest, ErrorsAreOfWhatIsShownAsWhite) {
  const auto dimmed = [](const dvec2& p) { return discs_and_floor(p) / 64.0F; };
  View view = make_refined_view(1.0F / 64.0F);
  const Refined expected = refine(view, discs_and_floor);
  view.error_target->white = 1.0F / 64.0F;
  const Refined refined = refine(view, dimmed);
  EXPECT_EQ(refined.counts, expected.counts);
  for (size_t i = 0; i < refined.means.size(); ++i) EXPECT_EQ(64.0F * refined.means[i], expected.means[i]);
}

// The curve of sRGB is steep for dark colours and flat for bright ones. Its slope is finite everywhere.
TEST(RefinementTest, AClaimIsShownAsWhatIsFarthestWithinIt) {
  const DisplayTransform plain;
  const vec3 shown = shown_claim(vec3(0.01F, 0.01F, 2.0F), vec3(0.0F, 0.8F, 9.0F), plain);
  EXPECT_FLOAT_EQ(shown.x, encode_srgb(0.01F));
  EXPECT_FLOAT_EQ(shown.y, encode_srgb(0.8F) - encode_srgb(0.79F));
  EXPECT_EQ(shown.z, 0.0F);
  // With one stop more, all values are twice as bright.
  const vec3 brighter = shown_claim(vec3(0.01F), vec3(0.2F), {.exposure_ev = 1.0F});
  EXPECT_NEAR(brighter.x, shown_claim(vec3(0.02F), vec3(0.4F), plain).x, 1e-6F);
  // Light that exceeds white without a tone mapping does not exceed white with one. If the tone mapping mixes channels,
  // a channel without error also gets an error.
  const DisplayTransform mapped{.tone_mapping = ToneMapping::kAgx};
  EXPECT_EQ(shown_claim(vec3(0.0F, 0.0F, 2.0F), vec3(0.5F, 0.5F, 3.0F), plain), vec3(0.0F));
  const vec3 mixed = shown_claim(vec3(0.0F, 0.0F, 2.0F), vec3(0.5F, 0.5F, 3.0F), mapped);
  EXPECT_GT(mixed.x, 0.01F);
  EXPECT_GT(mixed.z, 0.01F);
  EXPECT_EQ(shown_claim(vec3(0.0F), vec3(0.5F), mapped), vec3(0.0F));
  // If more light in one channel reduces the displayed value of another, red changes most if red decreases and green
  // increases.
  const DisplayTransform reinhard{.tone_mapping = ToneMapping::kReinhard};
  const vec3 red = glm::abs(shown_color(vec3(0.25F, 0.75F, 0.5F), reinhard) - shown_color(vec3(0.5F), reinhard));
  EXPECT_EQ(shown_claim(vec3(0.25F, 0.25F, 0.0F), vec3(0.5F), reinhard).x, red.x);
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(shown_claim(vec3(none, 0.0F, 0.0F), vec3(none), plain).x));
  ErrorTarget target;
  EXPECT_EQ(claimed_error(vec3(0.01F, 0.01F, 2.0F), vec3(0.0F, 0.8F, 4.0F), target), 0.5F);
  target.display = plain;
  EXPECT_EQ(claimed_error(vec3(0.01F, 0.01F, 2.0F), vec3(0.0F, 0.8F, 9.0F), target), shown.x);
}

// An unlit surface and a lit one beside it have the same light. The light has no edge, but the displayed picture has
// one.
TEST(RefinementTest, EdgesOfUnlitSurfacesAreRefinedAsShown) {
  View view = make_refined_view(1.0F / 64.0F);
  const auto count_samples = [&](const DisplayTransform& display) {
    view.error_target->display = display;
    Refinement refinement(view, {uvec2(0), view.size}, true);
    for (auto list = refinement.next(1000); !list.empty(); list = refinement.next(1000)) {
      const std::vector<vec3> radiance(list.size(), vec3(0.25F));
      std::vector<vec4> unlit;
      for (const ListedSample& sample : list) {
        const bool is_unlit = static_cast<float>(sample.pixel.x) + sample.place.x < 2.3F;
        unlit.push_back(is_unlit ? vec4(0.25F, 0.25F, 0.25F, 1.0F) : vec4(0.0F));
      }
      refinement.take(radiance, unlit);
    }
    EXPECT_EQ(refinement.unlit(0), vec4(0.25F, 0.25F, 0.25F, 1.0F));
    EXPECT_NEAR(refinement.unlit(2).w, 0.3F, 0.1F);
    EXPECT_EQ(refinement.unlit(3), vec4(0.0F));
    EXPECT_EQ(refinement.estimate(0).count(), view.error_target->min_samples) << "nothing ends here";
    return refinement.estimate(2).count();
  };
  EXPECT_EQ(count_samples({}), view.error_target->min_samples);
  EXPECT_GT(count_samples({.exposure_ev = 2.0F}), view.error_target->min_samples);
}

// If any channel is not finite, the error of the pixel is unknown, regardless of the other channels.
TEST(RefinementTest, AClaimThatIsNoNumberIsNeverSmallEnough) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  ErrorTarget linear;
  ErrorTarget shown;
  shown.display = DisplayTransform{.tone_mapping = ToneMapping::kAgx};
  for (const ErrorTarget& target : {linear, shown}) {
    for (int channel = 0; channel < 3; ++channel) {
      for (const float wrong : {none, infinite}) {
        vec3 claim(0.001F);
        vec3 mean(0.5F);
        claim[channel] = wrong;
        mean[channel] = infinite;
        EXPECT_FALSE(claimed_error(claim, mean, target) <= target.error) << channel << " " << wrong;
      }
    }
  }
  // Therefore the pixel takes all samples.
  for (int channel = 0; channel < 3; ++channel) {
    View view = make_refined_view(1.0F / 64.0F);
    const Refined refined = refine(view, [&](const dvec2& p) {
      vec3 radiance(0.5F);
      if (p.x < 1.0 && p.y < 1.0) radiance[channel] = infinite;
      return radiance;
    });
    EXPECT_EQ(refined.counts.front(), view.error_target->max_samples) << channel;
    EXPECT_FALSE(refined.are_near_enough.front()) << channel;
    EXPECT_EQ(refined.counts.back(), view.error_target->min_samples) << channel;
  }
}

TEST(RefinementTest, ErrorsAsTheyAreShownAskForMoreInTheDarkAndForLessInTheLight) {
  const auto edge_of = [](float dark, float bright) {
    return [=](const dvec2& p) { return vec3(p.x + 0.31 * p.y < 50.0 ? bright : dark); };
  };
  View linear = make_refined_view(1.0F / 64.0F);
  View shown = linear;
  shown.error_target->display.emplace();
  EXPECT_GT(refine(shown, edge_of(0.0F, 0.02F)).samples, refine(linear, edge_of(0.0F, 0.02F)).samples);
  EXPECT_LT(refine(shown, edge_of(0.7F, 1.0F)).samples, refine(linear, edge_of(0.7F, 1.0F)).samples);
  // Both sides are displayed as white, even if they differ.
  EXPECT_EQ(refine(shown, edge_of(3.0F, 9.0F)).samples, 8U * 96 * 64);
  const Refined refined = refine(shown, discs_and_floor);
  for (size_t i = 0; i < refined.means.size(); ++i) {
    const float claim = claimed_error(refined.claims[i], refined.means[i], *shown.error_target);
    ASSERT_EQ(refined.are_near_enough[i], claim <= 1.0F / 64.0F);
    ASSERT_TRUE(refined.are_near_enough[i] || refined.counts[i] == 256U);
  }
}

TEST(RefinementTest, WhatIsFlatTakesTheFirstSamplesAlone) {
  const View view = make_refined_view(1.0F / 4096.0F);
  const Refined refined = refine(view, [](const dvec2&) { return vec3(0.3F, 7.0F, 0.0F); });
  for (const uint32_t count : refined.counts) EXPECT_EQ(count, 8U);
  EXPECT_EQ(refined.means.front(), vec3(0.3F, 7.0F, 0.0F));
  EXPECT_EQ(refined.samples, 8U * 96 * 64);
}

// An edge of contrast c takes at most (0.62 c / E)^(4/3) samples, rounded up to a power of two. A few pixels whose
// batches happen to differ more take twice as many.
TEST(RefinementTest, AnEdgeTakesWhatItsContrastAsksFor) {
  const auto edge = [](const dvec2& p) { return vec3(p.x + 0.31 * p.y < 50.0 ? 0.25F : 0.0F); };
  const Refined refined = refine(make_refined_view(1.0F / 64.0F), edge);
  const auto with_more_than = [&](uint32_t samples) {
    return std::ranges::count_if(refined.counts, [&](uint32_t count) { return count > samples; });
  };
  EXPECT_GE(with_more_than(16), 64) << "one a row at least";
  EXPECT_LE(with_more_than(64), with_more_than(8) / 20);
  EXPECT_EQ(with_more_than(128), 0);
}

TEST(RefinementTest, ACropHasThePixelsOfTheWhole) {
  const View view = make_refined_view(1.0F / 64.0F);
  const Refined whole = refine(view, discs_and_floor);
  for (const PixelWindow& window : {PixelWindow{uvec2(0), uvec2(1)}, PixelWindow{uvec2(13, 20), uvec2(41, 37)},
                                    PixelWindow{uvec2(95, 0), uvec2(96, 64)}}) {
    const Refined crop = refine(view, discs_and_floor, window, 777);
    const uint32_t width = window.hi.x - window.lo.x;
    for (size_t i = 0; i < crop.means.size(); ++i) {
      const size_t at = (window.lo.y + i / width) * view.size.x + window.lo.x + i % width;
      ASSERT_EQ(crop.means[i], whole.means[at]);
      ASSERT_EQ(crop.claims[i], whole.claims[at]);
      ASSERT_EQ(crop.counts[i], whole.counts[at]);
    }
  }
}

TEST(RefinementTest, ItDoesNotMatterHowManyAreTracedAtOnce) {
  const View view = make_refined_view(1.0F / 64.0F);
  const PixelWindow window{uvec2(0), view.size};
  const Refined expected = refine(view, wires, window, 1U << 20);
  for (const size_t most : {1U, 8U, 1000U}) EXPECT_EQ(refine(view, wires, window, most).means, expected.means) << most;
}

// The forecast for the edge also has the correct magnitude.
TEST(RefinementTest, ASmallerErrorAfterALargerIsAsTheSmallerAtOnce) {
  const View view = make_refined_view(1.0F / 16.0F);
  const PixelWindow window{uvec2(0), view.size};
  Refinement refinement(view, window);
  run(refinement, discs_and_floor, 5000);
  for (const float error : {1.0F / 20.0F, 1.0F / 64.0F}) {
    const auto before = static_cast<double>(refinement.sample_count());
    const double forecast = refinement.foretell_samples(error);
    refinement.aim(error);
    run(refinement, discs_and_floor, 5000);
    const double taken = static_cast<double>(refinement.sample_count()) - before;
    EXPECT_GT(forecast, 0.6 * taken) << error;
    EXPECT_LT(forecast, 2.0 * taken) << error;
    const Refined expected = refine(make_refined_view(error), discs_and_floor);
    const Refined refined = results_of(refinement);
    EXPECT_EQ(refined.means, expected.means);
    EXPECT_EQ(refined.claims, expected.claims);
    EXPECT_EQ(refined.counts, expected.counts);
  }
}

// The forecast is checked from the end of the first samples on.
TEST(RefinementTest, WhatAllWillTakeIsForetold) {
  const View view = make_refined_view(1.0F / 64.0F);
  const auto total = static_cast<double>(refine(view, waves).samples);
  Refinement refinement(view, {uvec2(0), view.size});
  std::vector<vec3> seen;
  for (auto list = refinement.next(5000); !list.empty(); list = refinement.next(5000)) {
    if (refinement.sample_count() >= 8 * 96 * 64) {
      EXPECT_GT(refinement.foretell_total(), 0.75 * total);
      EXPECT_LT(refinement.foretell_total(), 1.5 * total);
    }
    seen.clear();
    for (const ListedSample& sample : list) seen.push_back(waves(dvec2(sample.pixel) + dvec2(sample.place)));
    refinement.take(seen);
  }
  EXPECT_EQ(refinement.foretell_total(), total);
}

// The batches of scattered paths count more, so pictures of them take more samples.
TEST(RefinementTest, ClaimsOfScatteredPathsAreLarger) {
  PixelEstimate estimate;
  for (int i = 0; i < 8; ++i) estimate.add(vec3((i / 2) % 2 == 0 ? 0.0F : 1.0F));
  const vec3 claim = estimate.claim(estimate.range(), vec3(0.0F), PixelEstimate::kBatchErrorOfPaths);
  EXPECT_NEAR(claim.x, 2.0 * std::sqrt(1.0 / 12.0), 1e-6);
  View view = make_refined_view(1.0F / 32.0F);
  const PixelWindow window{uvec2(0), view.size};
  const uint64_t samples = refine(view, wires, window).samples;
  view.mode.integrator = Integrator::kPath;
  EXPECT_GT(refine(view, wires, window).samples, samples);
}

// Where samples choose points of lights, a pixel does not stop because its own few batches happen to agree.
TEST(RefinementTest, NoiseAroundAPixelCountsIfSamplesChoosePoints) {
  PixelEstimate calm;
  PixelEstimate noisy;
  for (int i = 0; i < 8; ++i) {
    calm.add(vec3(0.5F));
    noisy.add(vec3((i / 2) % 2 == 0 ? 0.0F : 1.0F));
  }
  // Four batches with means of 0 and 1: the variance of the mean is 1 / 12.
  EXPECT_NEAR(noisy.variance().x, 1.0 / 12.0, 1e-6);
  EXPECT_EQ(calm.variance(), vec3(0.0F));
  EXPECT_EQ(calm.claim({vec3(0.5F), vec3(0.5F)}), vec3(0.0F));
  const vec3 claim = calm.claim({vec3(0.5F), vec3(0.5F)}, noisy.variance());
  EXPECT_NEAR(claim.x, 1.6 * std::sqrt(1.0 / 12.0), 1e-6);
  const std::vector<vec3> variances = {vec3(0.0F), vec3(0.9F), vec3(0.0F), vec3(0.0F)};
  EXPECT_FLOAT_EQ(mean_around(variances, uvec2(2, 2), 0, 1).x, 0.225F);

  // A picture of noise takes more samples with the term.
  const auto noise = [](const dvec2& p) {
    const auto bits = static_cast<uint64_t>(p.x * 1e6) * 0x9E3779B97F4A7C15U + static_cast<uint64_t>(p.y * 1e6);
    return vec3(static_cast<float>((bits * 0xBF58476D1CE4E5B9U) >> 40) * 0x1p-24F);
  };
  View view;
  view.size = uvec2(24, 16);
  view.error_target = ErrorTarget{.error = 1.0F / 16.0F, .min_samples = 8, .max_samples = 128};
  std::array<uint64_t, 2> samples{};
  for (const bool samples_points : {false, true}) {
    Refinement refinement(view, {uvec2(0), view.size}, false, {.any = samples_points});
    run(refinement, noise, 5000);
    samples[samples_points ? 1 : 0] = refinement.sample_count();
  }
  EXPECT_GT(samples[1], samples[0]);
}

/// Returns 1 for the given share of all places, and 0 for the others.
Scene make_rare_light(double share) {
  return [share](const dvec2& p) {
    uint64_t bits = std::bit_cast<uint64_t>(p.x) * 0x9E3779B97F4A7C15U + std::bit_cast<uint64_t>(p.y);
    for (int i = 0; i < 3; ++i) bits = (bits ^ (bits >> 31)) * 0xBF58476D1CE4E5B9U;
    return vec3(static_cast<double>(bits >> 11) * 0x1p-53 < share ? 1.0F : 0.0F);
  };
}

// Pixels whose first samples miss rare light do not stop earlier than the pixels around them, so that a picture is not
// too dark. With the rule of whitted pictures it is.
TEST(RefinementTest, RareLightIsNotLost) {
  constexpr double kShare = 0.1;
  const auto bias_of = [&](Integrator integrator, const SampledPoints& points) {
    View view = make_refined_view(1.0F / 16.0F, 4);
    view.mode.integrator = integrator;
    Refinement refinement(view, {uvec2(0), view.size}, false, points);
    run(refinement, make_rare_light(kShare), 1 << 16);
    double sum = 0.0;
    for (size_t i = 0; i < refinement.pixel_count(); ++i) sum += static_cast<double>(refinement.estimate(i).mean().x);
    return sum / static_cast<double>(refinement.pixel_count()) / kShare - 1.0;
  };
  EXPECT_LT(bias_of(Integrator::kWhitted, {}), -0.1);
  EXPECT_NEAR(bias_of(Integrator::kPath, {.any = true}), 0.0, 0.05);
  EXPECT_NEAR(bias_of(Integrator::kDirect, {.any = true, .of_many_sources = true}), 0.0, 0.02);
}

// Paths, and samples that choose one of many sources, take 16 first samples, unless that is more than the most.
TEST(RefinementTest, NoisyPixelsTakeMoreFirstSamples) {
  View view = make_refined_view(1.0F / 16.0F, 4);
  const auto first_samples = [&](Integrator integrator, const SampledPoints& points) {
    view.mode.integrator = integrator;
    return ClaimRule(view, points).first_samples;
  };
  EXPECT_EQ(first_samples(Integrator::kWhitted, {.any = true}), 4U);
  EXPECT_EQ(first_samples(Integrator::kDirect, {.any = true}), 4U);
  EXPECT_EQ(first_samples(Integrator::kDirect, {.any = true, .of_many_sources = true}), 16U);
  EXPECT_EQ(first_samples(Integrator::kPath, {.any = true}), 16U);
  view.error_target->max_samples = 8;
  EXPECT_EQ(first_samples(Integrator::kPath, {.any = true}), 8U);
  view.error_target->min_samples = view.error_target->max_samples = 32;
  EXPECT_EQ(first_samples(Integrator::kPath, {.any = true}), 32U);
}

TEST(RefinementTest, CropsOfSampledLightHaveThePixelsOfTheWhole) {
  View view = make_refined_view(1.0F / 16.0F, 4);
  view.size = uvec2(40, 24);
  view.mode.integrator = Integrator::kPath;
  const auto refine_part = [&](const PixelWindow& window) {
    Refinement refinement(view, window, false, {.any = true});
    run(refinement, make_rare_light(0.02), 5000);
    return results_of(refinement);
  };
  const Refined whole = refine_part({uvec2(0), view.size});
  EXPECT_GE(std::ranges::min(whole.counts), 16U);
  for (const PixelWindow& window : {PixelWindow{uvec2(3, 2), uvec2(4, 3)}, PixelWindow{uvec2(1, 5), uvec2(39, 24)},
                                    PixelWindow{uvec2(20, 0), uvec2(40, 1)}}) {
    const Refined part = refine_part(window);
    size_t i = 0;
    for (uint32_t y = window.lo.y; y < window.hi.y; ++y) {
      for (uint32_t x = window.lo.x; x < window.hi.x; ++x, ++i) {
        const size_t of_whole = size_t{y} * view.size.x + x;
        ASSERT_EQ(part.means[i], whole.means[of_whole]);
        ASSERT_EQ(part.claims[i], whole.claims[of_whole]);
        ASSERT_EQ(part.counts[i], whole.counts[of_whole]);
      }
    }
  }
}

}  // namespace
}  // namespace promin
