// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "view/display/device_work.h"
#include "view/display/swapchain.h"

namespace promin::app {

/// Submits the window's pictures to the display, one at a time. Only finish() waits.
class FrameQueue {
 public:
  FrameQueue(std::shared_ptr<const gpu::Device> device, Swapchain& swapchain);

  bool is_idle() const { return !work_.is_busy(); }
  /// Begins to draw to the next image of the swapchain. Returns null if no image is free now.
  const vk::raii::CommandBuffer* begin();
  uint32_t image() const { return image_; }
  /// Submits the recorded commands.
  void submit();
  /// Presents a finished image, if the device presents late (DeviceProfile).
  void poll();
  /// Waits until the device is idle, then calls poll().
  void finish();

 private:
  std::shared_ptr<const gpu::Device> device_;
  Swapchain* swapchain_;
  vk::raii::Semaphore ready_;
  DeviceWork work_;
  uint32_t image_ = 0;
};

}  // namespace promin::app
