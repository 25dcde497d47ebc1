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

/// Returns a pipeline that encodes the pixels of a film, as `display` shows them, to words of a buffer
/// (shaders/window/encode_film.comp). `exposure` contains the factor of the exposure, a float. `has_unlit` is the
/// result of ProgressivePicture::has_unlit().
gpu::ComputePipeline make_encoder(const gpu::Device& device, const gpu::Buffer& film, const gpu::Buffer& encoded,
                                  const gpu::Buffer& exposure, const DisplayTransform& display, bool has_unlit);

/// A picture for the window, with a word of 8-bit sRGB for each pixel.
struct EncodedPicture {
  std::span<const uint32_t> words;
  uvec2 size{0};
};

/// The picture of a view, traced on its device frame by frame and encoded for the window. A function waits for the
/// device only if its comment says so.
class TracedPicture {
 public:
  /// `set_apart` and `options` are arguments of ProgressivePicture. Throws vk::SystemError and RunError.
  TracedPicture(SceneOn scene, FeatureMask features, double budget_ms, const DisplayTransform& display,
                std::function<SceneOn()> set_apart, const FilmOptions& options);
  /// Waits for the device.
  ~TracedPicture();
  TracedPicture(const TracedPicture&) = delete;
  TracedPicture& operator=(const TracedPicture&) = delete;

  ProgressivePicture& picture() { return picture_; }
  const ProgressivePicture& picture() const { return picture_; }
  const SceneOn& scene() const { return scene_; }
  /// Returns the display transform. Only its exposure may change.
  const DisplayTransform& display() const { return display_; }
  void expose(float exposure_ev);

  /// Allocates memory for a window of this size; must not be called while busy.
  void resize(const uvec2& size);
  const uvec2& size() const { return size_; }
  /// Compiles the first kernels, and waits. Call resize() before.
  void warm_up();

  /// Returns whether a frame is running on the picture's device. No other frame may begin then.
  bool is_tracing() const { return work_.is_busy(); }
  /// Returns whether a frame is running.
  bool is_busy() const { return work_.is_busy() || (refining_ && refining_->is_busy()); }
  /// Returns whether the object may be destroyed without waiting.
  bool is_idle() const { return !is_busy() && !picture_.is_busy_beside(); }
  /// Returns whether there is anything to trace or to encode now.
  bool has_work() const;

  /// Begins a frame if possible. A frame traces and encodes a complete picture. Then `record_more`, if given, is called
  /// with the commands.
  void begin_frame(bool is_of_flight, double time_s,
                   const std::function<void(const vk::raii::CommandBuffer&)>& record_more = {});
  /// Requests a frame. The frame's time is measured from here on.
  void ask(double time_s);
  /// Returns the next finished frame. The caller must pass it to learn().
  std::optional<FinishedFrame> poll(double time_s);
  /// Adjusts the next budget to the frame's time. Throws RunError if the driver has cut loops.
  void learn(const FinishedFrame& frame);

  /// Returns the picture that was encoded since the last call, if there is one. It is valid until the next frame
  /// begins.
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
  /// The buffer from which the host reads the encoded picture.
  std::optional<gpu::Buffer> words_;
  std::array<std::optional<gpu::ComputePipeline>, kFilmCount> encoders_;
  /// The value of ProgressivePicture::shown_count() and the exposure when a picture was last encoded.
  uint64_t encoded_count_ = 0;
  float encoded_ev_ = 0.0F;
  bool is_encoding_ = false;
  uvec2 encoded_size_{0};
  bool has_encoded_ = false;

  /// The frames in flight: on the picture's device, and on the device that refines.
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
