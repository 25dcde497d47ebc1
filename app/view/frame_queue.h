// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "device/buffer.h"
#include "promin/ray_counts.h"
#include "view/swapchain.h"

namespace promin::app {

/// Device time of a frame's stages, in milliseconds; 0 where the queue has no timestamps.
struct StageTimes {
  double trace = 0.0;
  double display = 0.0;
  double overlay = 0.0;
};

/// What is known of a frame once the device has finished it.
struct FinishedFrame {
  StageTimes stages;
  RayCounts rays;
  /// The driver cut the tracing short (trace/film.h): pixels are wrong.
  bool has_cut_loops = false;
  /// The units of tracing (ProgressivePicture::record).
  double units = 0.0;
  /// Whether they are samples that refine (ProgressivePicture::has_recorded_list).
  bool has_list = false;
  /// The value of Frame::is_of_flight.
  bool is_of_flight = false;
  /// The time to its end, from when it was first asked for, or from the end of the frame before if that was later.
  /// Waiting for the display counts, a rest does not.
  double time_ms = 0.0;
};

/// The places in a frame where timestamps are taken.
enum class FrameMark { kBegin, kTraced, kDisplayed, kEnd };

/// One of the frames in flight.
struct Frame {
  vk::raii::CommandBuffer commands{nullptr};
  vk::raii::Semaphore ready{nullptr};
  vk::raii::Fence fence{nullptr};
  vk::raii::QueryPool queries{nullptr};
  std::optional<gpu::Buffer> counters;
  uint32_t image = 0;
  bool is_in_flight = false;
  bool is_presented = false;
  double begin_time = 0.0;
  double units = 0.0;
  bool has_list = false;
  /// Whether it shows the next camera of a flight.
  bool is_of_flight = false;
  /// Called when the device has finished the frame.
  std::function<void(const FinishedFrame&)> on_finished;

  void mark(FrameMark mark) const;
};

/// Frames on their way to the window. Nothing here waits, but for finish().
class FrameQueue {
 public:
  /// As many frames are in flight as suits the device.
  FrameQueue(const gpu::Device& device, Swapchain& swapchain);

  /// Says that a frame is wanted: its time counts from here on, or from the end of the frame before. Asking again has
  /// no effect.
  void ask();
  /// Whether another frame may begin beside those in flight.
  bool has_room() const;
  /// The next frame, with an image of the swapchain and its commands begun; null where none is free now.
  Frame* begin();
  /// Ends the commands and hands the frame to the device.
  void submit(Frame& frame);
  bool is_idle() const;

  /// Takes note of frames that the device has finished, in their order, and presents those that wait for that.
  void poll(const std::function<void(const FinishedFrame&)>& on_finished);
  /// Waits until the device is idle, then polls.
  void finish(const std::function<void(const FinishedFrame&)>& on_finished);

 private:
  FinishedFrame take(Frame& frame);
  double stage_ms(const Frame& frame, FrameMark from, FrameMark to) const;

  const gpu::Device* device_;
  Swapchain* swapchain_;
  vk::raii::CommandPool pool_;
  std::array<Frame, 2> frames_;
  size_t most_in_flight_;
  size_t next_ = 0;
  /// See DeviceProfile.
  bool presents_late_;
  /// When the next frame was first asked for; none where it has not been.
  std::optional<double> asked_time_;
  double last_end_time_ = 0.0;
};

}  // namespace promin::app
