// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "promin/math.h"
#include "promin/view.h"

namespace promin {

/// The least and the largest of some colors, by channel.
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

/// The range of a pixel and those around it. `ranges` are of `size`, row by row; `index` is the pixel's.
ColorRange range_around(std::span<const ColorRange> ranges, const uvec2& size, size_t index);

/// What the samples of a pixel come to, and how far their mean may be off (docs/model.md, "Error of a pixel"). The
/// samples are scrambled nets (ScrambledPoints), whose error falls as N^(-3/4). Computed on the host alone, so it is
/// the same for the same samples.
class PixelEstimate {
 public:
  /// Takes samples in their order. Their number is read where it is a power of two.
  void add(const vec3& radiance);

  uint32_t count() const { return count_; }
  vec3 mean() const { return vec3(sum_ / static_cast<double>(count_)); }
  const ColorRange& range() const { return range_; }

  /// By how much each channel's mean may be off, where `around` is the range of the first samples of the pixels around.
  /// From kMinRefinedSamples on.
  vec3 claim(const ColorRange& around) const;

 private:
  static constexpr uint32_t kMostBatches = 8;
  dvec3 sum_{0.0};
  std::array<vec3, kMostBatches> batches_{};
  ColorRange range_;
  uint32_t count_ = 0;
  /// Batches are nets too: of this many samples.
  uint32_t batch_size_ = 2;
};

/// By how much each channel of a pixel may be off that has taken any number of samples of a lattice, where `around` is
/// the range of its samples and of those of the pixels around: what an edge through it comes to. An estimate, and
/// no claim: it knows no more of the samples.
vec3 estimate_error(const ColorRange& around, uint32_t samples);

/// A pixel's largest claim as an error target measures it: of white or of the pixel's largest channel where that is
/// more, or as it is shown. NaN where it has a claim that is. `unlit` is its Aovs::unlit.
float claimed_error(const vec3& claim, const vec3& mean, const ErrorTarget& target, const vec4& unlit = vec4(0.0F));

/// A color as it is shown: exposed, tone mapped and encoded as sRGB, 0...1.
vec3 shown_color(const vec3& color, const DisplayTransform& display, const vec4& unlit = vec4(0.0F));

/// By how much each channel may be off as it is shown, 0...1, where the light of all is within the claim: by as much as
/// its corner that is farthest from the mean. Nothing within is farther where each channel that is shown rises or falls
/// with each of light, and so by most tone mappings, which mix channels; by `neutral` and `agx` a little may be
/// (docs/model.md, "Error of a pixel"). What is not finite stays so. All of it is an error of what is not unlit.
vec3 shown_claim(const vec3& claim, const vec3& mean, const DisplayTransform& display, const vec4& unlit = vec4(0.0F));

}  // namespace promin
