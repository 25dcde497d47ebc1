// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/pixel_estimate.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "promin/image.h"

namespace promin {
namespace {

/// If one edge crosses the pixel, the error of the covered area is less than this factor times N^(-3/4) in 95 of 100
/// cases.
constexpr double kEdgeError = 0.62;
/// Factor for a range of colours that only samples of a neighbouring pixel have seen.
constexpr double kNeighborShare = 0.5;

/// Returns N^(-3/4) for a power of two N.
double falloff(uint32_t count) {
  constexpr std::array kOfRemainder = {1.0, 0.59460355750136051, 0.35355339059327379, 0.21022410381342863};
  const int log2 = std::countr_zero(count);
  // 2^(-3 log2 / 4)
  return std::ldexp(kOfRemainder[static_cast<size_t>(log2 % 4)], -3 * (log2 / 4));
}

/// Returns the largest channel, which is NaN if any channel is NaN: std::max returns a NaN only in its first argument.
float largest_claim(const vec3& claim) {
  if (glm::any(glm::isnan(claim))) return std::numeric_limits<float>::quiet_NaN();
  return std::max({claim.x, claim.y, claim.z});
}

}  // namespace

ColorRange range_around(std::span<const ColorRange> ranges, const uvec2& size, size_t index) {
  const uvec2 place(index % size.x, index / size.x);
  const uvec2 lo = glm::max(place, uvec2(1)) - 1U;
  const uvec2 hi = glm::min(place + 2U, size);
  ColorRange range = ranges[index];
  for (uint32_t y = lo.y; y < hi.y; ++y) {
    for (uint32_t x = lo.x; x < hi.x; ++x) range.extend(ranges[static_cast<size_t>(y) * size.x + x]);
  }
  return range;
}

vec3 mean_around(std::span<const vec3> values, const uvec2& size, size_t index, uint32_t reach) {
  const uvec2 place(index % size.x, index / size.x);
  const uvec2 lo = glm::max(place, uvec2(reach)) - reach;
  const uvec2 hi = glm::min(place + reach + 1U, size);
  dvec3 sum(0.0);
  for (uint32_t y = lo.y; y < hi.y; ++y) {
    for (uint32_t x = lo.x; x < hi.x; ++x) sum += dvec3(values[static_cast<size_t>(y) * size.x + x]);
  }
  return vec3(sum / static_cast<double>((hi.x - lo.x) * (hi.y - lo.y)));
}

void PixelEstimate::add(const vec3& radiance) {
  if (count_ == batch_size_ * kMostBatches) {
    for (uint32_t i = 0; i < kMostBatches / 2; ++i) batches_[i] = batches_[2 * i] + batches_[2 * i + 1];
    std::fill(batches_.begin() + kMostBatches / 2, batches_.end(), vec3(0.0F));
    batch_size_ *= 2;
  }
  batches_[count_ / batch_size_] += radiance;
  sum_ += dvec3(radiance);
  if (count_ == 0) range_ = {radiance, radiance};
  range_.extend(radiance);
  ++count_;
}

double PixelEstimate::variance(int channel) const {
  assert(count_ >= kMinRefinedSamples && std::has_single_bit(count_));
  const uint32_t batches = count_ / batch_size_;
  const double mean = sum_[channel] / count_;
  double squares = 0.0;
  for (uint32_t i = 0; i < batches; ++i) {
    const double off = static_cast<double>(batches_[i][channel]) / batch_size_ - mean;
    squares += off * off;
  }
  return squares / (static_cast<double>(batches) * (batches - 1));
}

vec3 PixelEstimate::variance() const {
  return {variance(0), variance(1), variance(2)};
}

vec3 PixelEstimate::claim(const ColorRange& around, const vec3& spread, double batch_error) const {
  ColorRange wider = range_;
  wider.extend(around);
  const double edge = kEdgeError * falloff(count_);
  vec3 claim;
  for (int channel = 0; channel < 3; ++channel) {
    // The variance of few batches may happen to be small, so that of the first samples around also counts.
    const double deviation = std::max(batch_error * std::sqrt(variance(channel)),
                                      kBatchError * std::sqrt(static_cast<double>(spread[channel])));
    const auto width = [&](const ColorRange& range) {
      return static_cast<double>(range.hi[channel]) - static_cast<double>(range.lo[channel]);
    };
    claim[channel] =
        static_cast<float>(std::max({deviation, edge * width(range_), kNeighborShare * edge * width(wider)}));
  }
  return claim;
}

vec3 estimate_error(const ColorRange& around, uint32_t samples) {
  // N^(3/4) is computed with square roots, which have the same bits everywhere.
  const double root = std::sqrt(std::sqrt(static_cast<double>(samples)));
  const double edge = kEdgeError / (root * root * root);
  vec3 estimate(0.0F);
  for (int channel = 0; channel < 3; ++channel) {
    // If all samples are infinite, their difference is NaN.
    if (!(around.hi[channel] > around.lo[channel])) continue;
    estimate[channel] =
        static_cast<float>(edge * (static_cast<double>(around.hi[channel]) - static_cast<double>(around.lo[channel])));
  }
  return estimate;
}

float claimed_error(const vec3& claim, const vec3& mean, const ErrorTarget& target, const vec4& unlit) {
  if (!target.display) return largest_claim(claim) / std::max({target.white, mean.x, mean.y, mean.z});
  return largest_claim(shown_claim(claim, mean, *target.display, unlit));
}

vec3 shown_color(const vec3& color, const DisplayTransform& display, const vec4& unlit) {
  const vec3 mapped = apply(display, color, unlit);
  return {encode_srgb(mapped.x), encode_srgb(mapped.y), encode_srgb(mapped.z)};
}

vec3 shown_claim(const vec3& claim, const vec3& mean, const DisplayTransform& display, const vec4& unlit) {
  if (claim == vec3(0.0F)) return claim;
  const vec3 middle = shown_color(mean, display, unlit);
  vec3 farthest(0.0F);
  for (int corner = 0; corner < 8; ++corner) {
    const vec3 side((corner & 1) == 0 ? -1.0F : 1.0F, (corner & 2) == 0 ? -1.0F : 1.0F,
                    (corner & 4) == 0 ? -1.0F : 1.0F);
    farthest = glm::max(farthest, glm::abs(shown_color(mean + side * claim, display, unlit) - middle));
  }
  for (int channel = 0; channel < 3; ++channel) {
    if (!std::isfinite(claim[channel])) farthest[channel] = claim[channel];
  }
  return farthest;
}

}  // namespace promin
