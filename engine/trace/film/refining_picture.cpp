// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/refining_picture.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace promin {
namespace {

constexpr uint32_t kSamplesOfUnit = layout::BLOCK_SIZE * layout::BLOCK_SIZE;

View aimed_at(View view, float error) {
  view.error_target->error = error;
  return view;
}

}  // namespace

RefiningPicture::RefiningPicture(Film& film, const View& view)
    : view_(view),
      film_(&film),
      error_(first_error(*view.error_target)),
      refinement_(aimed_at(view, error_), {uvec2(0), view.size}, film.records().has_unlit(),
                  film.sampled_points(view)) {}

void RefiningPicture::prepare(double units) {
  assert(!is_done());
  if (has_samples()) take();
  const uint64_t most = std::min<uint64_t>(kMostListedSamples, film_->max_capacity() / kSamplesOfUnit * kSamplesOfUnit);
  for (;;) {
    const bool is_as_shown = done_ && done_->target == error_;
    if (is_as_shown) {
      error_ = next_error(*view_.error_target, error_);
      refinement_.aim(error_);
    }
    list_ = refinement_.next(std::min<uint64_t>(static_cast<uint64_t>(units) * kSamplesOfUnit, most));
    if (has_samples()) return film_->put_list(list_);
    done_ = PictureError{.target = error_};
    refinement_.add_to(*done_);
    samples_when_done_ = refinement_.sample_count();
    // A picture for which no sample was missing is shown only if it is the last one.
    if (!is_as_shown || is_done()) break;
  }
  pixels_ = make_pixels();
}

double RefiningPicture::record(const vk::raii::CommandBuffer& commands, double most_units) const {
  TileScheduler pieces = film_->cut(view_, list_window(list_.size()), film_->piece_options(view_.max_depth));
  film_->record_begin(commands, pieces);
  double recorded = 0.0;
  while (!pieces.is_done()) {
    const TileSample piece = pieces.next(most_units);
    film_->record(commands, piece);
    recorded += piece.units;
  }
  return recorded;
}

void RefiningPicture::take() {
  const ReadFilm read = film_->read_list();
  std::vector<vec3> radiance(list_.size());
  average_samples(read.records, 1, radiance);
  std::vector<vec4> unlit;
  read_unlit(read, list_.size(), unlit);
  list_ = {};
  refinement_.take(radiance, unlit);
}

std::vector<uvec4> RefiningPicture::make_pixels() const {
  std::vector<uvec4> records;
  const bool has_unlit = film_->records().has_unlit();
  records.reserve(refinement_.pixel_count() * (has_unlit ? 2 : 1));
  for (size_t i = 0; i < refinement_.pixel_count(); ++i) {
    const vec3 mean = refinement_.estimate(i).mean();
    records.emplace_back(std::bit_cast<uint32_t>(mean.x), std::bit_cast<uint32_t>(mean.y),
                         std::bit_cast<uint32_t>(mean.z), layout::NO_ORDER);
  }
  for (size_t i = 0; has_unlit && i < refinement_.pixel_count(); ++i) {
    records.push_back(std::bit_cast<uvec4>(refinement_.unlit(i)));
  }
  return records;
}

double RefiningPicture::fraction_done() const {
  const auto taken = static_cast<double>(refinement_.sample_count() + list_.size() - samples_when_done_);
  const double total = refinement_.foretell_total() - static_cast<double>(samples_when_done_);
  return total > 0.0 ? std::min(taken / total, 1.0) : 1.0;
}

}  // namespace promin
