// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "device/buffer.h"
#include "device/pipeline.h"
#include "promin/display.h"
#include "trace/film/progressive_picture.h"
#include "view/display/device_work.h"
#include "view/display/finished_frame.h"

namespace promin::app {

/// Makes what encodes the pixels of a film, as `display` shows them, to words of a buffer
/// (shaders/window/encode_film.comp). `exposure` holds the factor of the exposure, a float. `has_unlit` as
/// ProgressivePicture::has_unlit.
gpu::ComputePipeline make_encoder(const gpu::Device& device, const gpu::Buffer& film, const gpu::Buffer& encoded,
                                  const gpu::Buffer& exposure, const DisplayTransform& display, bool has_unlit);

/// A picture for the window: a word for each pixel, 8-bit sRGB.
struct EncodedPicture {
  std::span<const uint32_t> words;
  uvec2 size{0};
};

/// The picture of a view, traced on its device frame by frame and encoded for the window. No function waits for the
/// device unless stated.
class TracedPicture {
 public:
  /// `set_apart` and `options` are as for ProgressivePicture. Throws vk::SystemError and RunError.
  TracedPicture(SceneOn scene, FeatureMask features, double budget_ms, const DisplayTransform& display,
                std::function<SceneOn()> set_apart, const FilmOptions& options);
  /// Waits for the device.
  ~TracedPicture();
  TracedPicture(const TracedPicture&) = delete;
  TracedPicture& operator=(const TracedPicture&) = delete;

  ProgressivePicture& picture() { return picture_; }
  const ProgressivePicture& picture() const { return picture_; }
  const SceneOn& scene() const { return scene_; }
  /// Returns the display transform; only its exposure may change.
  const DisplayTransform& display() const { return display_; }
  void expose(float exposure_ev);

  /// Makes room for a window; must be idle.
  void resize(const uvec2& size);
  const uvec2& size() const { return size_; }
  /// Compiles the first kernels, and waits; call resize() before.
  void warm_up();

  /// Returns whether a frame is running on the picture's device, so that no other may begin.
  bool is_tracing() const { return work_.is_busy(); }
  /// Returns whether a frame is running.
  bool is_busy() const { return work_.is_busy() || (refining_ && refining_->is_busy()); }
  /// Returns whether it may be destroyed without waiting.
  bool is_idle() const { return !is_busy() && !picture_.is_busy_beside(); }
  /// Returns whether there is anything to trace or to encode now.
  bool has_work() const;

  /// Begins a frame if possible: traces, encodes a complete picture, then calls `record_more`, if given, with the
  /// commands.
  void begin_frame(bool is_of_flight, double time_s,
                   const std::function<void(const vk::raii::CommandBuffer&)>& record_more = {});
  /// Requests a frame; its time counts from here on.
  void ask(double time_s);
  /// Returns the next finished frame, which the caller must pass to learn().
  std::optional<FinishedFrame> poll(double time_s);
  /// Adjusts the next budget by its time. Throws RunError if the driver has cut loops.
  void learn(const FinishedFrame& frame);

  /// Returns the picture encoded since the last call, if any; valid until the next frame begins.
  std::optional<EncodedPicture> take_encoded();

 private:
  bool awaits_encoding() const;
  void begin_refining(double time_s);
  void record_encoding(const vk::raii::CommandBuffer& commands);
  FinishedFrame finish(FinishedFrame frame, const gpu::Buffer& counters, double time_s);

  SceneOn scene_;
  DisplayTransform display_;
  ProgressivePicture picture_;
  uvec2 size_{0};
  gpu::Buffer exposure_;
  gpu::Buffer counters_;
  std::optional<gpu::Buffer> encoded_;
  /// The buffer from which the host reads it.
  std::optional<gpu::Buffer> words_;
  std::array<std::optional<gpu::ComputePipeline>, kFilmCount> encoders_;
  /// The value of ProgressivePicture::shown_count when a picture was encoded last, and the exposure then.
  uint64_t encoded_count_ = 0;
  float encoded_ev_ = 0.0F;
  bool is_encoding_ = false;
  uvec2 encoded_size_{0};
  bool has_encoded_ = false;

  /// The frames in flight: of the picture's device, and of the one that refines.
  FinishedFrame frame_;
  FinishedFrame refined_frame_;
  std::optional<double> asked_time_;
  double begin_time_ = 0.0;
  double last_end_time_ = 0.0;
  DeviceWork work_;
  std::optional<gpu::Buffer> refining_counters_;
  std::unique_ptr<DeviceWork> refining_;
};

}  // namespace promin::app
