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
#include "trace/film/film.h"
#include "trace/film/refining_picture.h"

namespace promin {

/// A scene and its device. The scene keeps the device alive.
struct SceneOn {
  std::shared_ptr<const gpu::Device> device;
  std::shared_ptr<DeviceScene> scene;
};

/// A complete picture in device memory.
struct ShownPicture {
  /// Index of the picture's film, below kFilmCount.
  size_t film = 0;
  uvec2 size{0};
  /// Number of samples in the film's sums. It is 1 for a picture with an error target, because its film has means.
  uint32_t samples_per_pixel = 1;
  /// The accuracy; set for a picture with an error target.
  std::optional<PictureError> error;
  /// The error that was requested when the picture was traced, which may be smaller than that of the picture; 0 for a
  /// picture without an error target.
  float wanted_error = 0.0F;
  /// The number of pixels whose claim is within `wanted_error`.
  uint64_t finished_pixels = 0;

  /// Returns `view` with the number of samples, or the error, that the picture has reached. A complete picture of the
  /// returned view equals this picture. If the picture has an error, the view must have an error target.
  View view_of(View view) const;
};
inline constexpr size_t kFilmCount = 2;

/// The picture of a view that may change at any time, traced in pieces of about a frame's time. A new view first
/// appears with as many pixels as fit into a frame's time. If it does not change, it then appears in full size, then
/// with decreasing error down to its target (RefiningPicture) or, without a target, with 4, 16 and 64 samples per
/// pixel, each with the bits of `promin render`. One film is traced while the other, complete one is shown.
class ProgressivePicture {
 public:
  /// `options` are the options of the first pictures' films. `set_apart`, if given, returns the same scene, possibly on
  /// a separate device, on which the samples for refinement are traced. It is called on another thread.
  ProgressivePicture(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene, FeatureMask features,
                     double budget_ms, std::function<SceneOn()> set_apart = {}, const FilmOptions& options = {});

  /// Allocates memory for a window of this size; the device must be idle. Afterwards film(i) may be another buffer, and
  /// no picture is shown.
  void resize(const uvec2& size);
  /// Returns the largest possible size of a picture. It is the window's size if the device's buffers can be large
  /// enough.
  const uvec2& full_size() const { return full_size_; }
  const gpu::Buffer& film(size_t index) const { return films_[index].buffer(); }
  /// Returns whether films have a second record for each pixel, Aovs::unlit summed over samples, with
  /// FEATURE_UNLIT_SHARE.
  bool has_unlit() const { return films_[0].records().has_unlit(); }

  /// Sets the view to show from now on. Its size is the full size.
  void want(View view);
  const View& wanted() const { return wanted_; }
  /// Sets the scale of a view's first picture, as pixels of the window per pixel of the picture. With nullopt the scale
  /// is adapted to the time of a frame.
  void fix_scale(std::optional<double> scale) { fixed_scale_ = scale; }
  /// Pauses or resumes refinement after a view's first picture.
  void pause(bool is_paused) { is_paused_ = is_paused; }
  bool is_paused() const { return is_paused_; }

  /// Returns whether there is nothing to trace.
  bool is_settled() const;
  /// Returns whether the requested view is shown in its full size.
  bool is_complete() const;
  const std::optional<ShownPicture>& shown() const { return shown_; }
  /// Returns the number of pictures shown so far. resize() sets it to 0.
  uint64_t shown_count() const { return shown_count_; }
  /// Returns the traced fraction of the current picture; 1 if there is none.
  double fraction_done() const;
  /// Returns whether the pipeline for refinement is being compiled.
  bool is_compiling() const;
  /// Returns whether the destructor would wait for another thread.
  bool is_busy_beside() const;

  /// Records the next pieces, for about the budget. Returns the pieces' units. The result is 0 if there is nothing to
  /// trace, or nothing yet: see awaits_samples(). The commands are for the picture's device or, if refines_next(), for
  /// refining_device().
  double record(const vk::raii::CommandBuffer& commands);
  /// Returns whether the next record() refines the picture. The picture's device must not be using the films.
  bool refines_next() const;
  /// Returns the device for refinement; null while it is being created.
  std::shared_ptr<const gpu::Device> refining_device();
  /// Compiles the kernels of the first pictures, and waits until they are compiled.
  void warm_up() { films_[0].warm_up(); }
  /// Returns whether the next pieces depend on pieces that are being traced, or on a pipeline that is being compiled.
  bool awaits_samples() const;
  /// Returns whether the last record() recorded samples that must be reported to take_finished().
  bool has_recorded_list() const { return has_recorded_list_; }
  /// Records a copy of the ray counts of the recorded pieces, and sets the counts to 0.
  void record_take_counts(const vk::raii::CommandBuffer& commands, const gpu::Buffer& target) const;
  /// The result of the pieces of a record(), after the device has finished them.
  struct Finished {
    double units = 0.0;
    double time_ms = 0.0;
    bool has_cut_loops = false;
    /// The value that has_recorded_list() had.
    bool has_list = false;
  };
  /// Adjusts the next budget to the time of the pieces. Throws RunError if the driver has cut loops.
  void take_finished(const Finished& finished);
  void set_budget(double budget_ms);
  /// Takes over what another picture has learned about the time of pieces, so that the first picture has a similar
  /// size.
  void take_pace(const ProgressivePicture& other);

  /// Restarts tracing after a change of the scene that needs no other pipeline. The device must not be using the films.
  void take_scene_change();

  /// Records the next pieces, runs them and waits, for callers that do not record their own frames.
  void trace();
  /// Returns the pixels of the shown picture.
  Image read() const;

  static constexpr uint32_t kMostSamples = 64;

 private:
  /// Returns the view to trace now; nullopt if there is nothing to trace.
  std::optional<View> next_view() const;
  /// Returns whether the shown picture can be refined to an error, now or after the pause.
  bool is_refinable() const;
  /// Returns whether refinement is not finished.
  bool is_refining() const;
  double record_refinement(const vk::raii::CommandBuffer& commands, double most_units);
  /// Sets refined_ to the requested view with its next samples. Returns false if these are still being prepared.
  bool prepare_refined();
  void show_refined();
  uvec2 first_size() const;
  void begin(const vk::raii::CommandBuffer& commands, const View& view);
  void finish();

  const gpu::Device* device_;
  std::vector<Film> films_;
  /// The film for refinement, and its device.
  struct ListFilm {
    std::shared_ptr<const gpu::Device> device;
    std::unique_ptr<Film> film;
  };
  /// Creates the film for refinement at its first use.
  std::function<ListFilm()> make_list_film_;
  ListFilm list_film_;
  std::future<ListFilm> list_film_to_come_;
  /// True if long work of the host runs on other threads. Only for callers that record their own frames.
  bool works_beside_ = false;
  /// The picture that is being refined, for the view with the number refined_version_. Null while another thread
  /// prepares its next samples.
  std::unique_ptr<RefiningPicture> refined_;
  uint64_t refined_version_ = 0;
  std::future<std::unique_ptr<RefiningPicture>> refined_to_come_;
  /// True if refined_ has prepared samples to record or a picture to show.
  bool is_prepared_ = false;
  /// True if the samples of refined_ are being traced.
  bool is_list_under_way_ = false;
  /// The traced fraction of refined_'s next picture.
  double refined_fraction_ = 0.0;
  bool has_recorded_list_ = false;
  /// The buffer into which trace() copies the counts.
  std::optional<gpu::Buffer> counters_;
  /// The longest time of one dispatch in milliseconds. A longer budget uses several dispatches.
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
  /// The current picture, which is traced onto the film that is not shown.
  std::optional<TileScheduler> picture_;
  ShownPicture picture_when_done_;
  uint64_t picture_version_ = 0;
  bool is_first_ = false;
};

}  // namespace promin
