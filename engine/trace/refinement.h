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
#include "trace/pixel_estimate.h"

namespace promin {

/// A sample to trace.
struct ListedSample {
  /// In the whole picture.
  uvec2 pixel{0};
  /// In pixels from the pixel's upper left corner.
  vec2 place{0.5F};
};

/// Samples that are traced between two looks at what they bring.
inline constexpr size_t kMostListedSamples = size_t{1} << 19;

/// An error from which on a picture is coarse.
inline constexpr float kCoarseError = 1.0F / 32.0F;

/// What programs take for ErrorTarget::min_samples where the user does not say: fewer from kCoarseError on.
uint32_t usual_min_samples(float error);

/// The errors that a picture comes to on its way to that of a target: the first, and the next less than that by the
/// root of 2. `error` is more than the target's.
float first_error(const ErrorTarget& target);
float next_error(const ErrorTarget& target, float error);

/// How many pixels a window has.
size_t area_of(const PixelWindow& window);

/// A window and the pixels around it that are in a picture of this size.
PixelWindow with_neighbors(const PixelWindow& window, const uvec2& size);

/// The parts in which a picture is refined, one after the other, row by row: whoever has them traced each by itself has
/// the same done as with the whole.
std::vector<PixelWindow> parts_to_refine(const PixelWindow& window);

/// Refines a window of a picture until each of its pixels is within View::error_target or has its most samples: hands
/// out samples to trace, takes what was seen, doubles the samples of pixels whose claim is too large. Of the pixels
/// around the window it takes the first samples, for those next to them; so a pixel hangs on what is within one pixel
/// of it alone, and no crop or cut reaches a bit. Vulkan-free.
class Refinement {
 public:
  /// The view has an error target, and the window is not empty. With `has_unlit` take() gets what samples see of unlit
  /// surfaces.
  Refinement(const View& view, const PixelWindow& window, bool has_unlit = false);

  /// The samples to trace next, at most about `most`, whose colors take() gets before the next call. Empty where the
  /// window is as exact as it is asked for.
  std::span<const ListedSample> next(size_t most);
  /// `unlit` has as many values, as Aovs::unlit of a picture of one sample, or none without unlit surfaces.
  void take(std::span<const vec3> radiance, std::span<const vec4> unlit = {});

  /// Goes on with a smaller error, where all is as exact as was asked for. What this brings is what the smaller error
  /// would have brought at once.
  void aim(float error);

  /// How many samples it has taken, and about how many more it takes for a smaller error.
  uint64_t sample_count() const { return sample_count_; }
  double foretell_samples(float error) const;

  /// About how many samples the error takes that was asked for, with those that it has taken.
  double foretell_total() const { return total_; }

  /// Of the window's pixels, row by row.
  size_t pixel_count() const { return claims_.size(); }
  const PixelEstimate& estimate(size_t pixel) const { return estimates_[apron_index(pixel)]; }
  /// The mean of what its samples see of unlit surfaces, as Aovs::unlit; 0 without any.
  vec4 unlit(size_t pixel) const { return mean_unlit(apron_index(pixel)); }
  const vec3& claim(size_t pixel) const { return claims_[pixel]; }
  /// The claim as the target measures errors (claimed_error).
  float claimed_error(size_t pixel) const { return errors_[pixel]; }
  /// Whether the claim is within the error that is asked for; else samples were too few.
  bool is_near_enough(size_t pixel) const;
  /// Adds what the window's pixels have come to, but for the target.
  void add_to(PictureError& whole) const;

 private:
  size_t apron_index(size_t pixel) const;
  std::optional<size_t> window_index(size_t apron_index) const;
  uvec2 place_of(size_t apron_index) const;
  vec4 mean_unlit(size_t apron_index) const;
  void add_unlit(size_t apron_index, const vec3& radiance, const vec4& unlit);
  float judge_error(size_t apron_index, const vec3& claim) const;
  void judge_stage();
  /// Begins to double the samples of pixels that have `sample` of them or more, the fewest first; without any all is
  /// done.
  void begin_stage_from(uint32_t sample);

  ErrorTarget target_;
  PixelWindow window_;
  /// The window and the pixels around it that are in the picture.
  PixelWindow apron_;
  FilterPlaces filter_;
  /// By apron; beyond the window with the first samples alone.
  std::vector<PixelEstimate> estimates_;
  /// By apron, with unlit surfaces: sums of what samples see of them and, with ErrorTarget::display, what each sample
  /// alone would show, as linear light.
  std::vector<dvec4> unlit_sums_;
  std::vector<PixelEstimate> shown_;
  /// Of the first samples.
  std::vector<ColorRange> first_ranges_;
  /// By window.
  std::vector<vec3> claims_;
  /// The same as the target measures them, which takes some time of those that are shown.
  std::vector<float> errors_;
  /// The stage at hand: pixels by apron, samples [first, end) of each, how many pixels have been handed out.
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
