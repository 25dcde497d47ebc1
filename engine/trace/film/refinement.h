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
  /// The pixel in the whole picture.
  uvec2 pixel{0};
  /// Position in pixels from the pixel's upper left corner.
  vec2 place{0.5F};
};

/// Number of samples that are traced before their results are evaluated.
inline constexpr size_t kMostListedSamples = size_t{1} << 19;

/// The error from which a picture counts as coarse.
inline constexpr float kCoarseError = 1.0F / 32.0F;

/// Returns the programs' default of ErrorTarget::min_samples; fewer from kCoarseError on.
uint32_t usual_min_samples(float error);

/// Return the intermediate errors of a picture on its way to a target: the first, and the next, which is smaller by the
/// square root of 2. `error` is larger than the target's.
float first_error(const ErrorTarget& target);
float next_error(const ErrorTarget& target, float error);

/// Returns the number of pixels of a window.
size_t area_of(const PixelWindow& window);

/// Returns a window extended by the adjoining pixels that are in a picture of this size.
PixelWindow with_neighbors(const PixelWindow& window, const uvec2& size);

/// Returns the parts in which a picture is refined, one after the other, row by row. Refining each of them separately
/// gives the same result and work as refining the whole.
std::vector<PixelWindow> parts_to_refine(const PixelWindow& window);

/// Refines a window of a picture until each of its pixels is within View::error_target or has the largest number of
/// samples: it returns samples to trace, takes their results, and doubles the samples of pixels whose claim is too
/// large. It also takes the first samples of the pixels around the window, which their neighbours need. A pixel thus
/// depends only on pixels within a distance of one, and crops and divisions do not change its bits. Does not use
/// Vulkan.
class Refinement {
 public:
  /// The view must have an error target, and the window must not be empty. With `has_unlit` take() also receives the
  /// unlit surfaces of samples.
  Refinement(const View& view, const PixelWindow& window, bool has_unlit = false);

  /// Returns the samples to trace next, at most about `most`. take() must receive their colors before the next call.
  /// Empty if the window has reached its error.
  std::span<const ListedSample> next(size_t most);
  /// Takes the results of the samples. `unlit` has as many values, like Aovs::unlit of a picture of one sample, or none
  /// without unlit surfaces.
  void take(std::span<const vec3> radiance, std::span<const vec4> unlit = {});

  /// Continues with a smaller error after the current one is reached. The result is the same as if it had started with
  /// the smaller error.
  void aim(float error);

  /// Returns the number of samples taken.
  uint64_t sample_count() const { return sample_count_; }
  double foretell_samples(float error) const;

  /// Returns an estimate of the number of samples that the requested error needs, including those already taken.
  double foretell_total() const { return total_; }

  /// Results of the window's pixels, in row order.
  size_t pixel_count() const { return claims_.size(); }
  const PixelEstimate& estimate(size_t pixel) const { return estimates_[apron_index(pixel)]; }
  /// Returns the mean of the unlit surfaces of its samples, as Aovs::unlit; 0 without any.
  vec4 unlit(size_t pixel) const { return mean_unlit(apron_index(pixel)); }
  const vec3& claim(size_t pixel) const { return claims_[pixel]; }
  /// Returns the claim as the target measures errors (claimed_error).
  float claimed_error(size_t pixel) const { return errors_[pixel]; }
  /// Returns whether the claim is within the requested error; if not, there were too few samples.
  bool is_near_enough(size_t pixel) const;
  /// Adds the results of the window's pixels to a picture's, except the target.
  void add_to(PictureError& whole) const;

 private:
  size_t apron_index(size_t pixel) const;
  std::optional<size_t> window_index(size_t apron_index) const;
  uvec2 place_of(size_t apron_index) const;
  vec4 mean_unlit(size_t apron_index) const;
  void add_unlit(size_t apron_index, const vec3& radiance, const vec4& unlit);
  float judge_error(size_t apron_index, const vec3& claim) const;
  void judge_stage();
  /// Starts to double the samples of pixels that have `sample` samples or more, those with the fewest first; without
  /// such pixels everything is done.
  void begin_stage_from(uint32_t sample);

  ErrorTarget target_;
  PixelWindow window_;
  /// The window and the pixels around it that are in the picture.
  PixelWindow apron_;
  FilterPlaces filter_;
  /// One for each pixel of the apron. Pixels outside of the window have only their first samples.
  std::vector<PixelEstimate> estimates_;
  /// Indexed by apron, with unlit surfaces: sums of the samples' unlit colours and, with ErrorTarget::display, the
  /// displayed color of each sample alone, as linear light.
  std::vector<dvec4> unlit_sums_;
  std::vector<PixelEstimate> shown_;
  /// Color ranges of the first samples.
  std::vector<ColorRange> first_ranges_;
  /// Claims, indexed by window.
  std::vector<vec3> claims_;
  /// The same as the target measures them; computing displayed ones takes some time.
  std::vector<float> errors_;
  /// The current stage: pixels indexed by apron, samples [first, end) of each, and the number of pixels already
  /// returned.
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
