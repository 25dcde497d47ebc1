// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "promin/math.h"
#include "promin/view.h"

namespace promin {

/// The smallest and the largest value of some colours in each channel.
struct ColorRange {
  vec3 lo{0.0F};
  vec3 hi{0.0F};

  void extend(const vec3& color) {
    lo = glm::min(lo, color);
    hi = glm::max(hi, color);
  }
  void extend(const ColorRange& other) {
    lo = glm::min(lo, other.lo);
    hi = glm::max(hi, other.hi);
  }
};

/// Returns the range of a pixel and its neighbours. `ranges` has `size` entries in row order; `index` is the index of
/// the pixel.
ColorRange range_around(std::span<const ColorRange> ranges, const uvec2& size, size_t index);

/// Returns the mean of the values of a pixel and of the pixels at most `reach` columns and rows away, for the same
/// arguments.
vec3 mean_around(std::span<const vec3> values, const uvec2& size, size_t index, uint32_t reach);

/// The mean of a pixel's samples, and an estimate of its error (docs/model.md, "Error of a pixel"). The samples are
/// scrambled nets (ScrambledPoints), whose error decreases as N^(-3/4). Everything is computed on the host, so the
/// result is the same for the same samples.
class PixelEstimate {
 public:
  /// Factor of the deviation of batches, for pixels with many edges. The union of the 8 batches is better than their
  /// mean by the fourth root of their number, 1.68. Student's factor for 7 degrees of freedom is 2.37. The quotient is
  /// 1.4. The factor is larger, because pixels stop when their claim happens to be small.
  static constexpr double kBatchError = 1.6;
  /// The same factor for scattered paths, whose errors decrease more slowly than those of nets.
  static constexpr double kBatchErrorOfPaths = 2.0;

  /// Adds samples in their order. The mean may be read when the number of samples is a power of two.
  void add(const vec3& radiance);

  uint32_t count() const { return count_; }
  vec3 mean() const { return vec3(sum_ / static_cast<double>(count_)); }
  const ColorRange& range() const { return range_; }

  /// Returns the variance of each channel of the mean, estimated from batches. Requires at least kMinRefinedSamples
  /// samples.
  vec3 variance() const;

  /// Returns the claimed error of each channel of the mean. `around` is the range of the first samples of the pixel's
  /// neighbours. `spread` is the variance of the mean that the first samples of the pixel and of the pixels up to
  /// ClaimRule::reach suggest; 0 if the samples only decide where in the pixel they lie. Requires at least
  /// kMinRefinedSamples samples.
  vec3 claim(const ColorRange& around, const vec3& spread = vec3(0.0F), double batch_error = kBatchError) const;

 private:
  static constexpr uint32_t kMostBatches = 8;
  double variance(int channel) const;
  dvec3 sum_{0.0};
  std::array<vec3, kMostBatches> batches_{};
  ColorRange range_;
  uint32_t count_ = 0;
  /// Number of samples of a batch. A batch is a net too.
  uint32_t batch_size_ = 2;
};

/// Returns an estimate of the error of each channel of a pixel with any number of lattice samples: the error that an
/// edge through the pixel causes. `around` is the range of the samples of the pixel and its neighbours. The result is
/// an estimate and not a claim, because it depends only on this range.
vec3 estimate_error(const ColorRange& around, uint32_t samples);

/// Returns a pixel's largest claim in the measure of an error target: relative to white, or to the pixel's largest
/// channel if that is larger, or as displayed. The result is NaN if a claim is NaN. `unlit` is the pixel's Aovs::unlit.
float claimed_error(const vec3& claim, const vec3& mean, const ErrorTarget& target, const vec4& unlit = vec4(0.0F));

/// Returns a colour as displayed: exposed, tone mapped and encoded as sRGB, 0...1.
vec3 shown_color(const vec3& color, const DisplayTransform& display, const vec4& unlit = vec4(0.0F));

/// Returns the error of each displayed channel, 0...1, if the light of all channels is within the claim: the largest
/// distance of a displayed corner of the claim from the displayed mean. No point inside the claim is farther if each
/// displayed channel is monotonic in each channel of light. This holds for most tone mappings; for `neutral` and `agx`
/// a point may be slightly farther (docs/model.md, "Error of a pixel"). Values that are not finite stay as they are.
/// The error is that of the lit surfaces.
vec3 shown_claim(const vec3& claim, const vec3& mean, const DisplayTransform& display, const vec4& unlit = vec4(0.0F));

}  // namespace promin
