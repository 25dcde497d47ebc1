// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "device_scene/scrambled_points.h"
#include "promin/renderer.h"
#include "promin/view.h"
#include "trace/film/pixel_estimate.h"

namespace promin {

/// A sample to trace.
struct ListedSample {
  /// Coordinates of the pixel in the whole picture.
  uvec2 pixel{0};
  /// Position of the sample, in pixels from the pixel's upper left corner.
  vec2 place{0.5F};
  /// The number of the sample in its pixel.
  uint32_t number = 0;
};

/// Number of samples that are traced before their results are evaluated.
inline constexpr size_t kMostListedSamples = size_t{1} << 19;

/// The smallest error for which a picture counts as coarse.
inline constexpr float kCoarseError = 1.0F / 32.0F;

/// Returns the default of ErrorTarget::min_samples in the programs. For errors of kCoarseError or more it is smaller.
uint32_t usual_min_samples(float error);

/// Returns an intermediate error of a picture on its way to a target. first_error() returns the first one. next_error()
/// returns the next one, which is `error` divided by the square root of 2. `error` is larger than the target's.
float first_error(const ErrorTarget& target);
float next_error(const ErrorTarget& target, float error);

/// Returns the number of pixels of a window.
size_t area_of(const PixelWindow& window);

/// Returns a window extended by the pixels of a picture of this size that are at most `reach` pixels away.
PixelWindow with_neighbors(const PixelWindow& window, const uvec2& size, uint32_t reach = 1);

/// Returns the parts in which a picture is refined one after the other, row by row. Refining each part separately gives
/// the same result and needs the same work as refining the whole picture.
std::vector<PixelWindow> parts_to_refine(const PixelWindow& window);

/// The points that samples choose besides their places in the pixel. The rule of claims depends on them.
struct SampledPoints {
  /// True if samples choose points of lights or of the lens.
  bool any = false;
  /// True if each sample also chooses one of many sources of light.
  bool of_many_sources = false;
};

/// The rule by which pixels stop and claims are computed (docs/model.md, "Error of a pixel").
struct ClaimRule {
  ClaimRule(const View& view, const SampledPoints& points);

  /// The number of samples that each pixel takes first.
  uint32_t first_samples;
  /// Factor of the deviation of batches.
  double batch_error;
  /// True if the variances of the first samples of the pixels around count, up to this distance.
  bool has_spread;
  uint32_t reach = 1;
  /// Factor of these variances.
  float spread = 1.0F;
};

/// Refines a window of a picture until each of its pixels is within View::error_target or has the largest number of
/// samples. It returns samples to trace, receives their results, and doubles the number of samples of pixels whose
/// claim is too large. It also takes the first samples of the pixels around the window, up to ClaimRule::reach. A pixel
/// thus depends only on itself and the first samples of the pixels up to this distance, and its bits do not depend on
/// crops and divisions. This code does not use Vulkan.
class Refinement {
 public:
  /// The view must have an error target, and the window must not be empty. With `has_unlit`, take() also receives the
  /// unlit surfaces of samples.
  Refinement(const View& view, const PixelWindow& window, bool has_unlit = false, const SampledPoints& points = {});

  /// Returns the samples to trace next, at most about `most`. take() must receive their colours before the next call.
  /// Empty if the window has reached its error.
  std::span<const ListedSample> next(size_t most);
  /// Receives the results of the samples. `unlit` has the same number of values, in the form of Aovs::unlit of a
  /// picture with one sample; it is empty without unlit surfaces.
  void take(std::span<const vec3> radiance, std::span<const vec4> unlit = {});

  /// Continues with a smaller error after the current one is reached. The result is the same as if the refinement had
  /// started with the smaller error.
  void aim(float error);

  /// Returns the number of samples taken.
  uint64_t sample_count() const { return sample_count_; }
  double foretell_samples(float error) const;

  /// Returns an estimate of the number of samples that the requested error needs, including those already taken.
  double foretell_total() const { return total_; }

  /// The following functions return results for the window's pixels, in row order.
  size_t pixel_count() const { return claims_.size(); }
  const PixelEstimate& estimate(size_t pixel) const { return estimates_[apron_index(pixel)]; }
  /// Returns the mean of the unlit surfaces of a pixel's samples, in the form of Aovs::unlit; 0 if there are none.
  vec4 unlit(size_t pixel) const { return mean_unlit(apron_index(pixel)); }
  const vec3& claim(size_t pixel) const { return claims_[pixel]; }
  /// Returns a pixel's claim in the measure of the target (claimed_error).
  float claimed_error(size_t pixel) const { return errors_[pixel]; }
  /// Returns whether a pixel's claim is within the requested error. If not, it has the largest number of samples.
  bool is_near_enough(size_t pixel) const;
  /// Returns the number of the window's pixels whose claim, in the measure of the target, is at most `error`.
  uint64_t count_within(float error) const;
  /// Adds the results of the window's pixels to those of a picture. The target does not change.
  void add_to(PictureError& whole) const;

 private:
  size_t apron_index(size_t pixel) const;
  std::optional<size_t> window_index(size_t apron_index) const;
  uvec2 place_of(size_t apron_index) const;
  vec4 mean_unlit(size_t apron_index) const;
  void add_unlit(size_t apron_index, const vec3& radiance, const vec4& unlit);
  float judge_error(size_t apron_index, const vec3& claim) const;
  void judge_stage();
  /// Starts to double the number of samples of pixels that have at least `sample` samples; the pixels with the fewest
  /// samples come first. If there are no such pixels, the refinement is done.
  void begin_stage_from(uint32_t sample);

  ErrorTarget target_;
  ClaimRule rule_;
  PixelWindow window_;
  /// The window and the pixels around it that are in the picture.
  PixelWindow apron_;
  FilterPlaces filter_;
  uint32_t seed_;
  /// The estimates, one for each pixel of the apron. Pixels outside the window have only their first samples.
  std::vector<PixelEstimate> estimates_;
  /// Sums for pictures with unlit surfaces, indexed by the pixels of the apron: sums of the samples' unlit colours and,
  /// with ErrorTarget::display, the displayed color of each sample alone, as linear light.
  std::vector<dvec4> unlit_sums_;
  std::vector<PixelEstimate> shown_;
  /// Ranges of the colours of the first samples.
  std::vector<ColorRange> first_ranges_;
  /// Variances of the means of the first samples; empty if samples choose no points.
  std::vector<vec3> first_variances_;
  /// Claims, indexed by the pixels of the window.
  std::vector<vec3> claims_;
  /// The claims in the measure of the target. They are stored, because computing displayed claims takes time.
  std::vector<float> errors_;
  /// The current stage: pixels, as indices into the apron; samples [first, end) of each pixel; and the number of pixels
  /// that next() has already returned.
  std::vector<uint32_t> pixels_;
  uint32_t first_sample_ = 0;
  uint32_t end_sample_;
  size_t handed_out_ = 0;
  size_t listed_pixels_ = 0;
  std::vector<ListedSample> list_;
  uint64_t sample_count_ = 0;
  double total_;
};

}  // namespace promin
