// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/progressive_picture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/divide_up.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "trace/kernels/cut_loops.h"

namespace promin {
namespace {

constexpr uint32_t kSampleStep = 4;
/// The smallest scale of a first picture, relative to a side of the window.
constexpr double kMinScale = 1.0 / 16.0;
/// Each step uses this fraction of the scale that seems affordable.
constexpr double kScaleStep = 0.98;

uvec2 scale_size(const uvec2& size, double scale) {
  return glm::max(uvec2(1), uvec2(glm::round(dvec2(size) * scale)));
}

template <typename Result>
bool is_ready(const std::future<Result>& result) {
  return result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

double count_blocks(const uvec2& size) {
  return static_cast<double>(divide_up(size.x, layout::BLOCK_SIZE)) * divide_up(size.y, layout::BLOCK_SIZE);
}

}  // namespace

View ShownPicture::view_of(View view) const {
  view.size = size;
  view.samples_per_pixel = samples_per_pixel;
  if (error) {
    view.error_target->error = error->target;
  } else {
    view.error_target.reset();
  }
  return view;
}

ProgressivePicture::ProgressivePicture(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene,
                                       FeatureMask features, double budget_ms, std::function<SceneOn()> set_apart,
                                       const FilmOptions& options)
    : device_(&device),
      longest_piece_ms_(device.profile().target_dispatch_ms),
      budget_ms_(budget_ms),
      pacer_(budget_ms, TileScheduler::kMinBlocks) {
  films_.reserve(kFilmCount);
  for (size_t i = 0; i < kFilmCount; ++i) films_.emplace_back(device, scene, features, options);
  works_beside_ = static_cast<bool>(set_apart);
  make_list_film_ = [&device, scene, features, set_apart = std::move(set_apart)] {
    ListFilm list;
    std::shared_ptr<const DeviceScene> listed = scene;
    if (set_apart) {
      const SceneOn apart = set_apart();
      list.device = apart.device;
      listed = apart.scene;
    } else {
      // The caller keeps the device alive.
      list.device = std::shared_ptr<const gpu::Device>(std::shared_ptr<void>(), &device);
    }
    list.film = std::make_unique<Film>(*list.device, listed, features | layout::FEATURE_LISTED_SAMPLES);
    // Drivers compile in the first dispatch of a pipeline.
    list.film->warm_up();
    return list;
  };
}

void ProgressivePicture::resize(const uvec2& size) {
  const double most_pixels = films_[0].max_capacity();
  const double pixels = static_cast<double>(size.x) * size.y;
  full_size_ = pixels <= most_pixels ? size : uvec2(dvec2(size) * std::sqrt(most_pixels / pixels));
  for (Film& film : films_) film.reserve(full_size_.x * full_size_.y);
  shown_.reset();
  shown_count_ = 0;
  picture_.reset();
  refined_.reset();
  is_prepared_ = false;
  is_list_under_way_ = false;
}

void ProgressivePicture::want(View view) {
  view.size = full_size_;
  if (shows_same(view, wanted_) && view.error_target == wanted_.error_target) return;
  wanted_ = view;
  ++wanted_version_;
}

bool ProgressivePicture::is_settled() const {
  return !next_view() && (!picture_ || (is_paused_ && !is_first_)) && (is_paused_ || !is_refining());
}

bool ProgressivePicture::is_refinable() const {
  return wanted_.error_target && is_complete();
}

bool ProgressivePicture::is_refining() const {
  return is_refinable() && !(refined_ && refined_version_ == wanted_version_ && refined_->is_done());
}

bool ProgressivePicture::is_compiling() const {
  return list_film_to_come_.valid() && !is_ready(list_film_to_come_);
}

bool ProgressivePicture::is_busy_beside() const {
  return is_compiling() || (refined_to_come_.valid() && !is_ready(refined_to_come_));
}

bool ProgressivePicture::awaits_samples() const {
  if (picture_ || next_view() || !is_refining()) return false;
  return is_busy_beside() || is_list_under_way_;
}

double ProgressivePicture::fraction_done() const {
  if (picture_) return picture_->fraction_done();
  return is_refining() && refined_version_ == wanted_version_ ? refined_fraction_ : 1.0;
}

bool ProgressivePicture::is_complete() const {
  return shown_ && shown_version_ == wanted_version_ && shown_->size == full_size_;
}

std::optional<View> ProgressivePicture::next_view() const {
  View view = wanted_;
  view.samples_per_pixel = 1;
  view.error_target.reset();
  if (!shown_ || shown_version_ != wanted_version_) {
    view.size = first_size();
    return view;
  }
  if (is_paused_) return std::nullopt;
  if (shown_->size != full_size_) return view;
  if (wanted_.error_target) return std::nullopt;
  view.samples_per_pixel = kSampleStep * shown_->samples_per_pixel;
  return view.samples_per_pixel <= kMostSamples ? std::optional(view) : std::nullopt;
}

uvec2 ProgressivePicture::first_size() const {
  if (fixed_scale_) return scale_size(full_size_, *fixed_scale_);
  // The code counts blocks and not pixels. Blocks at the right and lower edge are not full, so a smaller picture may
  // have the same number of blocks.
  const double affordable = std::max<double>(pacer_.units(), TileScheduler::kMinBlocks);
  double scale = 1.0;
  while (scale > kMinScale && count_blocks(scale_size(full_size_, scale)) > affordable) {
    scale =
        std::max(kMinScale, kScaleStep * scale * std::sqrt(affordable / count_blocks(scale_size(full_size_, scale))));
  }
  return scale_size(full_size_, scale);
}

void ProgressivePicture::begin(const vk::raii::CommandBuffer& commands, const View& view) {
  const size_t film = shown_ ? 1 - shown_->film : 0;
  is_first_ = !shown_ || shown_version_ != wanted_version_;
  picture_ = films_[film].cut(view, {uvec2(0), view.size}, films_[film].piece_options(view.max_depth));
  picture_when_done_ = {film, view.size, view.samples_per_pixel, std::nullopt, 0.0F, 0};
  picture_version_ = wanted_version_;
  films_[film].record_begin(commands, *picture_);
}

double ProgressivePicture::record(const vk::raii::CommandBuffer& commands) {
  has_recorded_list_ = false;
  // The first picture of a view is finished even if the view has changed meanwhile. Otherwise a slow device would never
  // show a picture.
  if (picture_ && picture_version_ != wanted_version_ && !is_first_) picture_.reset();
  if (picture_ && is_paused_ && !is_first_) return 0.0;
  const double most_units = pacer_.units() * std::min(1.0, longest_piece_ms_ / budget_ms_);
  if (!picture_) {
    const std::optional<View> view = next_view();
    if (!view) return is_paused_ || !is_refining() ? 0.0 : record_refinement(commands, most_units);
    begin(commands, *view);
  }
  double units = 0.0;
  while (!picture_->is_done() && units < pacer_.units()) {
    const TileSample piece = picture_->next(std::min(most_units, pacer_.units() - units));
    films_[picture_when_done_.film].record(commands, piece);
    units += piece.units;
  }
  if (picture_->is_done()) finish();
  return units;
}

bool ProgressivePicture::refines_next() const {
  const bool is_dropped = picture_ && picture_version_ != wanted_version_ && !is_first_;
  return (!picture_ || is_dropped) && !next_view() && !is_paused_ && is_refining();
}

std::shared_ptr<const gpu::Device> ProgressivePicture::refining_device() {
  if (list_film_.film) return list_film_.device;
  if (!list_film_to_come_.valid()) list_film_to_come_ = std::async(std::launch::async, make_list_film_);
  if (!is_ready(list_film_to_come_)) return nullptr;
  list_film_ = list_film_to_come_.get();
  return list_film_.device;
}

double ProgressivePicture::record_refinement(const vk::raii::CommandBuffer& commands, double most_units) {
  // Frames are drawn meanwhile, so the code does not wait for a list that is still being traced.
  if (!refining_device() || is_list_under_way_ || !prepare_refined()) return 0.0;
  is_prepared_ = false;
  has_recorded_list_ = is_list_under_way_ = refined_->has_samples();
  if (has_recorded_list_) return refined_->record(commands, most_units);
  show_refined();
  return 0.0;
}

bool ProgressivePicture::prepare_refined() {
  if (refined_to_come_.valid()) {
    if (!is_ready(refined_to_come_)) return false;
    refined_ = refined_to_come_.get();
    is_prepared_ = true;
  }
  if (is_prepared_ && refined_version_ == wanted_version_) return true;
  // A refined picture needs much memory, so the old one is destroyed before the next is created.
  if (std::exchange(refined_version_, wanted_version_) != wanted_version_) {
    refined_.reset();
    refined_fraction_ = 0.0;
  }
  const auto prepare = [film = list_film_.film.get(), view = wanted_,
                        units = pacer_.units()](std::unique_ptr<RefiningPicture> picture) {
    if (!picture) picture = std::make_unique<RefiningPicture>(*film, view);
    picture->prepare(units);
    return picture;
  };
  is_prepared_ = false;
  const std::launch policy = works_beside_ ? std::launch::async : std::launch::deferred;
  refined_to_come_ = std::async(policy, prepare, std::move(refined_));
  if (works_beside_) return false;
  refined_to_come_.wait();
  return prepare_refined();
}

void ProgressivePicture::show_refined() {
  // The device has finished all frames that used the hidden film before it traced the samples of this picture.
  const size_t film = 1 - shown_->film;
  films_[film].put_pixels(refined_->take_pixels(), full_size_);
  picture_when_done_ = {film, full_size_, 1, refined_->error(), refined_->wanted_error(), refined_->count_finished()};
  picture_version_ = refined_version_;
  refined_fraction_ = 0.0;
  finish();
}

void ProgressivePicture::finish() {
  shown_ = picture_when_done_;
  shown_version_ = picture_version_;
  ++shown_count_;
  picture_.reset();
}

void ProgressivePicture::record_take_counts(const vk::raii::CommandBuffer& commands, const gpu::Buffer& target) const {
  const Film& film = has_recorded_list_ ? *list_film_.film : films_[picture_when_done_.film];
  film.record_take_counts(commands, target);
}

void ProgressivePicture::set_budget(double budget_ms) {
  budget_ms_ = budget_ms;
  pacer_.aim(budget_ms);
}

void ProgressivePicture::take_finished(const Finished& finished) {
  if (finished.units == 0.0) return;
  // If loops were cut, the samples are wrong. The caller receives an error, and the picture continues with other
  // samples.
  if (finished.has_list) is_list_under_way_ = false;
  if (finished.has_list && refined_) refined_fraction_ = refined_->fraction_done();
  // Drivers compile in the first dispatch of a pipeline, so its time is not used.
  if (std::exchange(is_warm_, true)) pacer_.learn(finished.units, finished.time_ms);
  refuse_cut_loops(finished.has_cut_loops);
}

void ProgressivePicture::take_pace(const ProgressivePicture& other) {
  if (!other.is_warm_) return;
  pacer_ = other.pacer_;
  budget_ms_ = other.budget_ms_;
  is_warm_ = true;
}

void ProgressivePicture::take_scene_change() {
  for (Film& film : films_) film.bind_scene();
  if (list_film_to_come_.valid()) list_film_ = list_film_to_come_.get();
  if (refined_to_come_.valid()) refined_to_come_.wait();
  if (list_film_.film) list_film_.film->bind_scene();
  picture_.reset();
  ++wanted_version_;
}

void ProgressivePicture::trace() {
  if (!counters_) counters_.emplace(gpu::Buffer::make_readback(*device_, Film::kCountersBytes));
  if (list_film_to_come_.valid()) list_film_to_come_.wait();
  Finished finished;
  const Stopwatch waiting;
  device_->run([&](const vk::raii::CommandBuffer& commands) {
    finished.units = record(commands);
    record_take_counts(commands, *counters_);
  });
  finished.time_ms = waiting.ms();
  finished.has_cut_loops = were_loops_cut(counters_->mapped());
  finished.has_list = has_recorded_list_;
  take_finished(finished);
}

Image ProgressivePicture::read() const {
  Image image;
  image.size = shown_->size;
  image.pixels.resize(static_cast<size_t>(image.size.x) * image.size.y);
  std::vector<uvec4> records(image.pixels.size());
  films_[shown_->film].buffer().read(std::as_writable_bytes(std::span(records)), Film::kPixelsOffset);
  average_samples(records, shown_->samples_per_pixel, image.pixels);
  return image;
}

}  // namespace promin
