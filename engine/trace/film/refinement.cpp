// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/refinement.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/parallel.h"

namespace promin {
namespace {

/// Number of pixels that a thread processes at a time.
constexpr size_t kChunk = 1024;

/// The side in pixels of the parts in which a picture is refined.
constexpr uint32_t kPartSide = 256;

constexpr float kFirstError = 0.125F;
constexpr float kErrorStep = 1.41421356F;

/// Pixels of scattered paths, and pixels whose samples choose one of many sources, take at least this number of samples
/// first. Fewer samples often miss the light that matters, and pixels that miss it would stop early and be too dark.
constexpr uint32_t kFirstNoisySamples = 16;

/// The distance in pixels up to which the variances of first samples count with Integrator::kDirect and kPath. The more
/// pixels decide together, the less a pixel's own samples decide when it stops, and the less its mean is biased.
constexpr uint32_t kSpreadReach = 2;

/// The square of 2.0 / 1.6: few samples choose the source whose light matters.
constexpr float kSpreadOfManySources = 1.5625F;

/// Estimated ratio of all samples to the first samples, used before anything is known.
constexpr double kMoreThanFirst = 1.5;

}  // namespace

uint32_t usual_min_samples(float error) {
  return error >= kCoarseError ? kMinRefinedSamples : ErrorTarget{}.min_samples;
}

float first_error(const ErrorTarget& target) {
  return std::max(target.error, kFirstError);
}

float next_error(const ErrorTarget& target, float error) {
  return std::max(target.error, error / kErrorStep);
}

size_t area_of(const PixelWindow& window) {
  const uvec2 size = window.hi - window.lo;
  return static_cast<size_t>(size.x) * size.y;
}

PixelWindow with_neighbors(const PixelWindow& window, const uvec2& size, uint32_t reach) {
  return {glm::max(window.lo, uvec2(reach)) - reach, glm::min(window.hi + reach, size)};
}

std::vector<PixelWindow> parts_to_refine(const PixelWindow& window) {
  std::vector<PixelWindow> parts;
  for (uint32_t y = window.lo.y; y < window.hi.y; y += kPartSide) {
    for (uint32_t x = window.lo.x; x < window.hi.x; x += kPartSide) {
      parts.push_back({uvec2(x, y), glm::min(window.hi, uvec2(x, y) + kPartSide)});
    }
  }
  return parts;
}

ClaimRule::ClaimRule(const View& view, const SampledPoints& points)
    : first_samples(view.error_target->min_samples),
      batch_error(view.mode.integrator == Integrator::kPath ? PixelEstimate::kBatchErrorOfPaths
                                                            : PixelEstimate::kBatchError),
      has_spread(points.any) {
  if (!points.any || view.mode.integrator == Integrator::kWhitted) return;
  reach = kSpreadReach;
  const bool is_noisy = view.mode.integrator == Integrator::kPath || points.of_many_sources;
  if (is_noisy) first_samples = std::max(first_samples, std::min(kFirstNoisySamples, view.error_target->max_samples));
  if (points.of_many_sources) spread = kSpreadOfManySources;
}

Refinement::Refinement(const View& view, const PixelWindow& window, bool has_unlit, const SampledPoints& points)
    : target_(*view.error_target),
      rule_(view, points),
      window_(window),
      apron_(with_neighbors(window, view.size, rule_.reach)),
      filter_(view),
      seed_(view.seed),
      estimates_(area_of(apron_)),
      unlit_sums_(has_unlit ? area_of(apron_) : 0),
      shown_(has_unlit && target_.display ? area_of(apron_) : 0),
      first_ranges_(area_of(apron_)),
      first_variances_(rule_.has_spread ? area_of(apron_) : 0),
      claims_(area_of(window)),
      errors_(area_of(window)),
      pixels_(area_of(apron_)),
      end_sample_(rule_.first_samples),
      total_(kMoreThanFirst * rule_.first_samples * static_cast<double>(area_of(apron_))) {
  std::iota(pixels_.begin(), pixels_.end(), 0U);
}

size_t Refinement::apron_index(size_t pixel) const {
  const uint32_t width = window_.hi.x - window_.lo.x;
  const uvec2 place = window_.lo - apron_.lo + uvec2(pixel % width, pixel / width);
  return static_cast<size_t>(place.y) * (apron_.hi.x - apron_.lo.x) + place.x;
}

std::optional<size_t> Refinement::window_index(size_t apron_index) const {
  const uvec2 place = place_of(apron_index);
  if (glm::any(glm::lessThan(place, window_.lo)) || glm::any(glm::greaterThanEqual(place, window_.hi))) return {};
  const uvec2 inside = place - window_.lo;
  return static_cast<size_t>(inside.y) * (window_.hi.x - window_.lo.x) + inside.x;
}

uvec2 Refinement::place_of(size_t apron_index) const {
  const uint32_t width = apron_.hi.x - apron_.lo.x;
  return apron_.lo + uvec2(apron_index % width, apron_index / width);
}

std::span<const ListedSample> Refinement::next(size_t most) {
  if (handed_out_ == pixels_.size() && !pixels_.empty()) {
    judge_stage();
    begin_stage_from(end_sample_);
  }
  const uint32_t samples = end_sample_ - first_sample_;
  listed_pixels_ = std::min(pixels_.size() - handed_out_, std::max<size_t>(most / samples, 1));
  list_.resize(listed_pixels_ * samples);
  for_each_chunk(listed_pixels_, kChunk, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const uvec2 pixel = place_of(pixels_[handed_out_ + i]);
      const ScrambledPoints points(pixel, seed_);
      for (uint32_t j = 0; j < samples; ++j) {
        const uint32_t number = first_sample_ + j;
        list_[i * samples + j] = {pixel, filter_.at(points.at(number)), number};
      }
    }
  });
  return list_;
}

void Refinement::take(std::span<const vec3> radiance, std::span<const vec4> unlit) {
  assert(radiance.size() == list_.size() && unlit.size() == (unlit_sums_.empty() ? 0 : list_.size()));
  const uint32_t samples = end_sample_ - first_sample_;
  for_each_chunk(listed_pixels_, kChunk, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const uint32_t pixel = pixels_[handed_out_ + i];
      for (size_t j = i * samples; j < (i + 1) * samples; ++j) {
        estimates_[pixel].add(radiance[j]);
        if (!unlit.empty()) add_unlit(pixel, radiance[j], unlit[j]);
      }
      if (first_sample_ != 0) continue;
      first_ranges_[pixel] = estimates_[pixel].range();
      if (!first_variances_.empty()) first_variances_[pixel] = estimates_[pixel].variance();
    }
  });
  handed_out_ += listed_pixels_;
  sample_count_ += radiance.size();
}

vec4 Refinement::mean_unlit(size_t apron_index) const {
  if (unlit_sums_.empty()) return vec4(0.0F);
  return vec4(unlit_sums_[apron_index] / static_cast<double>(estimates_[apron_index].count()));
}

void Refinement::add_unlit(size_t apron_index, const vec3& radiance, const vec4& unlit) {
  unlit_sums_[apron_index] += dvec4(unlit);
  if (!shown_.empty()) shown_[apron_index].add(apply(*target_.display, radiance, unlit));
}

float Refinement::judge_error(size_t apron_index, const vec3& claim) const {
  const vec4 unlit = mean_unlit(apron_index);
  const float error = promin::claimed_error(claim, estimates_[apron_index].mean(), target_, unlit);
  if (shown_.empty() || unlit.w == 0.0F) return error;
  // At the edge of an unlit surface, the light may be constant while the displayed colour is not.
  const PixelEstimate& shown = shown_[apron_index];
  ErrorTarget as_it_is = target_;
  as_it_is.display = DisplayTransform();
  return std::max(error, promin::claimed_error(shown.claim(shown.range()), shown.mean(), as_it_is));
}

void Refinement::judge_stage() {
  const uvec2 size = apron_.hi - apron_.lo;
  for_each_chunk(pixels_.size(), kChunk, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const std::optional<size_t> pixel = window_index(pixels_[i]);
      if (!pixel) continue;
      const PixelEstimate& estimate = estimates_[pixels_[i]];
      vec3 spread(0.0F);
      if (!first_variances_.empty()) {
        const float share = static_cast<float>(rule_.first_samples) / static_cast<float>(estimate.count());
        spread = rule_.spread * share * mean_around(first_variances_, size, pixels_[i], rule_.reach);
      }
      claims_[*pixel] = estimate.claim(range_around(first_ranges_, size, pixels_[i]), spread, rule_.batch_error);
      errors_[*pixel] = judge_error(pixels_[i], claims_[*pixel]);
    }
  });
}

void Refinement::begin_stage_from(uint32_t sample) {
  pixels_.clear();
  handed_out_ = 0;
  total_ = static_cast<double>(sample_count_) + foretell_samples(target_.error);
  for (; sample < target_.max_samples; sample *= 2) {
    for (size_t pixel = 0; pixel < claims_.size(); ++pixel) {
      if (estimate(pixel).count() != sample || is_near_enough(pixel)) continue;
      pixels_.push_back(static_cast<uint32_t>(apron_index(pixel)));
    }
    if (pixels_.empty()) continue;
    first_sample_ = sample;
    end_sample_ = 2 * sample;
    return;
  }
}

void Refinement::aim(float error) {
  assert(pixels_.empty() && error <= target_.error);
  target_.error = error;
  begin_stage_from(rule_.first_samples);
}

double Refinement::foretell_samples(float error) const {
  double samples = 0.0;
  for (size_t pixel = 0; pixel < claims_.size(); ++pixel) {
    const double count = estimate(pixel).count();
    // The estimate assumes that the claim decreases like that of an edge.
    const double ratio = static_cast<double>(errors_[pixel] / error);
    // For ratios that are not finite there is no estimate.
    if (!(ratio > 1.0) || std::isinf(ratio)) continue;
    const double wanted = count * std::exp2(std::ceil(std::log2(ratio) * 4.0 / 3.0));
    samples += std::max(std::min<double>(wanted, target_.max_samples) - count, 0.0);
  }
  return samples;
}

bool Refinement::is_near_enough(size_t pixel) const {
  return errors_[pixel] <= target_.error;
}

uint64_t Refinement::count_within(float error) const {
  return static_cast<uint64_t>(std::ranges::count_if(errors_, [error](float claimed) { return claimed <= error; }));
}

void Refinement::add_to(PictureError& whole) const {
  whole.first_samples = rule_.first_samples;
  for (size_t pixel = 0; pixel < pixel_count(); ++pixel) {
    whole.largest_claim = std::max(whole.largest_claim, errors_[pixel]);
    whole.unmet_pixels += is_near_enough(pixel) ? 0 : 1;
    whole.samples += estimate(pixel).count();
  }
}

}  // namespace promin
