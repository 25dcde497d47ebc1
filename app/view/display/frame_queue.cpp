// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/display/frame_queue.h"

namespace promin::app {

FrameQueue::FrameQueue(std::shared_ptr<const gpu::Device> device, Swapchain& swapchain)
    : device_(device),
      swapchain_(&swapchain),
      ready_(device->handle(), vk::SemaphoreCreateInfo()),
      work_(std::move(device)) {}

const vk::raii::CommandBuffer* FrameQueue::begin() {
  if (!is_idle()) return nullptr;
  const std::optional<uint32_t> image = swapchain_->acquire(*ready_);
  if (!image) return nullptr;
  image_ = *image;
  return &work_.begin();
}

void FrameQueue::submit() {
  work_.submit(*ready_, swapchain_->rendered(image_));
  if (!device_->profile().presents_late) swapchain_->present(image_);
}

void FrameQueue::poll() {
  if (work_.take_finished() && device_->profile().presents_late) swapchain_->present(image_);
}

void FrameQueue::finish() {
  device_->wait_idle();
  poll();
  // The queue may use the image that was presented last until the device is idle again.
  device_->wait_idle();
}

}  // namespace promin::app
