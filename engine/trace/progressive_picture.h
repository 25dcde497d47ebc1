// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "promin/image.h"
#include "promin/view.h"
#include "trace/film.h"
#include "trace/refining_picture.h"

namespace promin {

/// A scene and the device that it is on, which lives as long.
struct SceneOn {
  std::shared_ptr<const gpu::Device> device;
  std::shared_ptr<DeviceScene> scene;
};

/// A complete picture in device memory.
struct ShownPicture {
  /// The index of its film, below kFilmCount.
  size_t film = 0;
  uvec2 size{0};
  /// What the film's sums are over: 1 where the film has means, of a picture with an error target.
  uint32_t samples_per_pixel = 1;
  /// Of a picture with an error target.
  std::optional<PictureError> error;

  /// The view that gives this picture, where `view` is what it shows.
  View view_of(View view) const;
};
inline constexpr size_t kFilmCount = 2;

/// The picture of a view that may change any time, traced in pieces of about a frame's time each. A new view comes at
/// once in as few pixels as a frame has time for; while it stands still it comes in full size, then with less and less
/// error until that of its target (RefiningPicture) or, without one, with 4, 16 and 64 samples a pixel, each as
/// `promin render` gives it. One film is traced while the other, complete, is shown.
class ProgressivePicture {
 public:
  /// `options` are those of the first pictures' films. `set_apart`, where there is one, gives the same scene, perhaps
  /// on a device of its own: the samples that refine are traced there. It is called on another thread.
  ProgressivePicture(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene, FeatureMask features,
                     double budget_ms, std::function<SceneOn()> set_apart = {}, const FilmOptions& options = {});

  /// Makes room for a window; the device must be idle. Afterwards film(i) may be another buffer, and nothing is shown.
  void resize(const uvec2& size);
  /// The largest size that a picture can have: that of the window, if the device's buffers can be large enough.
  const uvec2& full_size() const { return full_size_; }
  const gpu::Buffer& film(size_t index) const { return films_[index].buffer(); }
  /// Whether films have a second record of each pixel, Aovs::unlit summed over samples: with FEATURE_UNLIT_SHARE.
  bool has_unlit() const { return films_[0].records().has_unlit(); }

  /// The view to show from now on, in full size.
  void want(View view);
  const View& wanted() const { return wanted_; }
  /// Fixes the scale of a view's first picture, in its pixels for one of the window; nullopt adapts it to the time of a
  /// frame.
  void fix_scale(std::optional<double> scale) { fixed_scale_ = scale; }
  /// While paused, nothing is refined beyond a view's first picture.
  void pause(bool is_paused) { is_paused_ = is_paused; }
  bool is_paused() const { return is_paused_; }

  /// Whether there is nothing to trace.
  bool is_settled() const;
  /// Whether the wanted view is shown in full size.
  bool is_complete() const;
  const std::optional<ShownPicture>& shown() const { return shown_; }
  /// How many pictures have been shown so far; resize() starts anew.
  uint64_t shown_count() const { return shown_count_; }
  /// The fraction of the current picture that is traced; 1 where there is none.
  double fraction_done() const;
  /// Whether the pipeline that refines pictures to an error is being compiled.
  bool is_compiling() const;
  /// Whether the destructor would wait for another thread.
  bool is_busy_beside() const;

  /// Records the next pieces, for about the budget. Returns their units; 0 where there was nothing to trace, or
  /// nothing yet: see awaits_samples(). The commands are for the picture's device, or where refines_next() for
  /// refining_device().
  double record(const vk::raii::CommandBuffer& commands);
  /// Whether the next record() refines. It needs that the picture's device is idle with respect to the films.
  bool refines_next() const;
  /// The device that refines; null, and it is being made, before that is known.
  std::shared_ptr<const gpu::Device> refining_device();
  /// Compiles what traces the first pictures, and waits.
  void warm_up() { films_[0].warm_up(); }
  /// Whether the next pieces hang on those that are under way, or on a pipeline that is being compiled.
  bool awaits_samples() const;
  /// Whether the last record() recorded samples that take_finished() must be told of.
  bool has_recorded_list() const { return has_recorded_list_; }
  /// Records a copy of the ray counts of what record() recorded, and resets them.
  void record_take_counts(const vk::raii::CommandBuffer& commands, const gpu::Buffer& target) const;
  /// The result of the pieces of a record(), once the device has finished them.
  struct Finished {
    double units = 0.0;
    double time_ms = 0.0;
    bool has_cut_loops = false;
    /// What has_recorded_list() was.
    bool has_list = false;
  };
  /// Learns from their time, so that the next budget is met. Throws RunError where the driver cut loops.
  void take_finished(const Finished& finished);
  void set_budget(double budget_ms);

  /// Takes note that the scene has changed parts that need no other pipeline: all is traced again. The device must be
  /// idle with respect to the films.
  void take_scene_change();

  // For callers without frames of their own.
  /// Records the next pieces, runs them and waits.
  void trace();
  /// The pixels of what is shown.
  Image read() const;

  static constexpr uint32_t kMostSamples = 64;

 private:
  /// The view to trace now; nullopt where all is done.
  std::optional<View> next_view() const;
  /// Whether what is shown is refined to an error, now or when the pause is over.
  bool is_refinable() const;
  /// Whether that is yet to be done.
  bool is_refining() const;
  double record_refinement(const vk::raii::CommandBuffer& commands, double most_units);
  /// Makes refined_ that of the wanted view, with its next samples. False where that is still under way.
  bool prepare_refined();
  void show_refined();
  uvec2 first_size() const;
  void begin(const vk::raii::CommandBuffer& commands, const View& view);
  void finish();

  const gpu::Device* device_;
  std::vector<Film> films_;
  /// The film that samples are refined on, and its device.
  struct ListFilm {
    std::shared_ptr<const gpu::Device> device;
    std::unique_ptr<Film> film;
  };
  /// Makes it; it is there as soon as somebody has needed it.
  std::function<ListFilm()> make_list_film_;
  ListFilm list_film_;
  std::future<ListFilm> list_film_to_come_;
  /// Whether what takes the host long is done on other threads: only for callers with frames of their own.
  bool works_beside_ = false;
  /// The picture that is refined, of the view of refined_version_; null while it prepares its next samples.
  std::unique_ptr<RefiningPicture> refined_;
  uint64_t refined_version_ = 0;
  std::future<std::unique_ptr<RefiningPicture>> refined_to_come_;
  /// Whether refined_ has prepared what is to be recorded or shown.
  bool is_prepared_ = false;
  /// Whether its samples are being traced.
  bool is_list_under_way_ = false;
  /// The part of refined_'s next picture that is traced.
  double refined_fraction_ = 0.0;
  bool has_recorded_list_ = false;
  /// The buffer that trace() takes the counts into.
  std::optional<gpu::Buffer> counters_;
  /// The longest time of one dispatch; a longer budget takes several.
  double longest_piece_ms_;
  double budget_ms_;
  Pacer pacer_;
  bool is_warm_ = false;
  uvec2 full_size_{1};
  std::optional<double> fixed_scale_;
  bool is_paused_ = false;

  View wanted_;
  uint64_t wanted_version_ = 0;
  std::optional<ShownPicture> shown_;
  uint64_t shown_version_ = 0;
  uint64_t shown_count_ = 0;
  /// The current picture, on the film that is not shown.
  std::optional<TileScheduler> picture_;
  ShownPicture picture_when_done_;
  uint64_t picture_version_ = 0;
  bool is_first_ = false;
};

}  // namespace promin
