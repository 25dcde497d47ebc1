// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "promin/renderer.h"
#include "promin/view.h"
#include "trace/film/film.h"
#include "trace/film/refinement.h"

namespace promin {

/// A whole picture with an error target, refined in the frames of a window as in Renderer::render_within: to an error
/// of 1/8, which is then divided by the square root of 2 repeatedly, down to the view's own error. Samples are traced
/// one list at a time, and the results of a list determine the next one, so prepare() and record() alternate.
class RefiningPicture {
 public:
  /// `film` must have FEATURE_LISTED_SAMPLES, must have no other users, and must outlive this object. The view has no
  /// crop.
  RefiningPicture(Film& film, const View& view);

  /// Receives the results of the recorded samples after the device has finished, and copies the next samples to the
  /// film, about this number of units (TileSample::units). This takes the host some time. If it finds no samples, the
  /// picture has reached error(); then it is_done() or continues with a smaller error.
  void prepare(double units);
  /// Returns whether prepare() has found samples.
  bool has_samples() const { return !list_.empty(); }
  /// Records the tracing of these samples in pieces of at most `most_units`. Returns the number of units.
  double record(const vk::raii::CommandBuffer& commands, double most_units) const;

  /// Returns the view's own error.
  float wanted_error() const { return view_.error_target->error; }
  /// Returns whether the picture has reached the view's own error.
  bool is_done() const { return done_ && wanted_error() == done_->target; }
  /// Returns the accuracy of the last complete picture.
  const std::optional<PictureError>& error() const { return done_; }
  /// Returns the number of pixels whose claim is within the view's own error.
  uint64_t count_finished() const { return refinement_.count_within(wanted_error()); }
  /// Returns the picture's pixels in the form of a film with one sample. May be called once after prepare() has found
  /// no samples.
  std::vector<uvec4> take_pixels() { return std::exchange(pixels_, {}); }
  /// Returns approximately the fraction of the next picture's samples that will be traced after the samples of
  /// prepare() are traced.
  double fraction_done() const;

 private:
  void take();
  std::vector<uvec4> make_pixels() const;

  View view_;
  Film* film_;
  /// The current target error.
  float error_;
  Refinement refinement_;
  std::optional<PictureError> done_;
  uint64_t samples_when_done_ = 0;
  /// The samples being traced.
  std::span<const ListedSample> list_;
  std::vector<uvec4> pixels_;
};

}  // namespace promin
