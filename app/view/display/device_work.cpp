// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/display/device_work.h"

#include <limits>
#include <utility>

namespace promin::app {

DeviceWork::DeviceWork(std::shared_ptr<const gpu::Device> device)
    : device_(std::move(device)),
      pool_(device_->handle(),
            vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device_->queue_family())),
      fence_(device_->handle(), vk::FenceCreateInfo()) {
  const vk::CommandBufferAllocateInfo allocation(*pool_, vk::CommandBufferLevel::ePrimary, 1);
  commands_ = std::move(vk::raii::CommandBuffers(device_->handle(), allocation).front());
  if (device_->timestamp_period_ns() == 0.0) return;
  queries_ = vk::raii::QueryPool(device_->handle(), vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, kMostMarks));
}

DeviceWork::~DeviceWork() {
  try {
    if (!is_busy_) return;
    const vk::Result result = device_->handle().waitForFences({*fence_}, VK_TRUE, std::numeric_limits<uint64_t>::max());
    static_cast<void>(result);
  } catch (const vk::SystemError&) {
    // If the device was lost, an earlier exception has reported it.
  }
}

const vk::raii::CommandBuffer& DeviceWork::begin() {
  mark_count_ = 0;
  commands_.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  if (*queries_) commands_.resetQueryPool(*queries_, 0, kMostMarks);
  return commands_;
}

void DeviceWork::mark() {
  if (*queries_) commands_.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *queries_, mark_count_);
  ++mark_count_;
}

void DeviceWork::submit(vk::Semaphore wait, vk::Semaphore signal) {
  commands_.end();
  const vk::PipelineStageFlags wait_stage = vk::PipelineStageFlagBits::eColorAttachmentOutput;
  const vk::CommandBuffer commands = *commands_;
  vk::SubmitInfo info;
  info.setCommandBuffers(commands);
  if (wait) info.setWaitSemaphores(wait).setWaitDstStageMask(wait_stage);
  if (signal) info.setSignalSemaphores(signal);
  device_->use_queue([&](const vk::raii::Queue& queue) { queue.submit(info, *fence_); });
  is_busy_ = true;
}

bool DeviceWork::take_finished() {
  if (!is_busy_ || fence_.getStatus() != vk::Result::eSuccess) return false;
  device_->handle().resetFences({*fence_});
  is_busy_ = false;
  return true;
}

double DeviceWork::ms_after(uint32_t mark) const {
  if (!*queries_ || mark + 1 >= mark_count_) return 0.0;
  const auto get = [&](uint32_t index) {
    return queries_.getResult<uint64_t>(index, 1, sizeof(uint64_t), vk::QueryResultFlagBits::e64).second;
  };
  return 1e-6 * device_->timestamp_period_ns() * static_cast<double>(device_->ticks_between(get(mark), get(mark + 1)));
}

}  // namespace promin::app
