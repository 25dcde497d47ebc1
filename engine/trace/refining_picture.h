// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "promin/renderer.h"
#include "promin/view.h"
#include "trace/film.h"
#include "trace/refinement.h"

namespace promin {

/// A whole picture with an error target, refined within frames of a window as Renderer::render_within does: to an error
/// of 1/8, then to each that is less by the root of 2, until it has the view's own. Samples are traced a list at a
/// time, and what a list has seen says what the next one holds.
class RefiningPicture {
 public:
  /// `film` has FEATURE_LISTED_SAMPLES, is used by nothing else and lives longer. The view has no crop.
  RefiningPicture(Film& film, const View& view);

  /// Whether what the last record() recorded has not been taken yet: there is nothing to record until then.
  bool is_under_way() const { return !list_.empty(); }
  /// Records tracing the next samples, of about so many units (TileSample::units), none in a piece of more than
  /// `most_units`. Returns their units; 0 where the picture has come to error(), and is_done() or aims for less.
  double record(const vk::raii::CommandBuffer& commands, double units, double most_units);
  /// Takes what was recorded, once the device has finished it.
  void take();

  /// Whether the picture has the view's own error.
  bool is_done() const { return done_ && view_.error_target->error == done_->target; }
  /// Of the last picture that is complete.
  const std::optional<PictureError>& error() const { return done_; }
  /// Its pixels, as a film of one sample holds them.
  std::vector<uvec4> pixels() const;
  /// Of the samples of the next picture, about.
  double fraction_done() const;

 private:
  View view_;
  Film* film_;
  /// What is aimed for.
  float error_;
  Refinement refinement_;
  std::optional<PictureError> done_;
  uint64_t samples_when_done_ = 0;
  /// What is being traced.
  std::span<const ListedSample> list_;
};

}  // namespace promin
