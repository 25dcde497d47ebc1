// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "promin/renderer.h"
#include "promin/view.h"
#include "trace/film.h"
#include "trace/refinement.h"

namespace promin {

/// A whole picture with an error target, refined within frames of a window as Renderer::render_within does: to an error
/// of 1/8, then to each that is less by the root of 2, until it has the view's own. Samples are traced a list at a
/// time, and what a list has seen says what the next one holds. So prepare() and record() take turns.
class RefiningPicture {
 public:
  /// `film` has FEATURE_LISTED_SAMPLES, is used by nothing else and lives longer. The view has no crop.
  RefiningPicture(Film& film, const View& view);

  /// Takes what was recorded, once the device has finished it, and puts the next samples on the film, about so many
  /// units (TileSample::units). It takes the host a while. Where it finds no samples the picture has come to error(),
  /// and is_done() or aims for less.
  void prepare(double units);
  /// Whether prepare() has found samples.
  bool has_samples() const { return !list_.empty(); }
  /// Records tracing them, in pieces of at most `most_units`. Returns their units.
  double record(const vk::raii::CommandBuffer& commands, double most_units) const;

  /// Whether the picture has the view's own error.
  bool is_done() const { return done_ && view_.error_target->error == done_->target; }
  /// Of the last picture that is complete.
  const std::optional<PictureError>& error() const { return done_; }
  /// Its pixels, as a film of one sample holds them, once after prepare() has found no samples.
  std::vector<uvec4> take_pixels() { return std::exchange(pixels_, {}); }
  /// The part of the next picture's samples, about, that is traced once those of prepare() are.
  double fraction_done() const;

 private:
  void take();
  std::vector<uvec4> make_pixels() const;

  View view_;
  Film* film_;
  /// What is aimed for.
  float error_;
  Refinement refinement_;
  std::optional<PictureError> done_;
  uint64_t samples_when_done_ = 0;
  /// What is being traced.
  std::span<const ListedSample> list_;
  std::vector<uvec4> pixels_;
};

}  // namespace promin
