// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/frame_queue.h"

#include <algorithm>
#include <utility>

#include "trace/film.h"
#include "view/window.h"

namespace promin::app {
namespace {

using Stage = vk::PipelineStageFlagBits;
constexpr uint32_t kMarkCount = 4;

}  // namespace

void Frame::mark(FrameMark mark) const {
  if (*queries) commands.writeTimestamp(Stage::eBottomOfPipe, *queries, static_cast<uint32_t>(mark));
}

FrameQueue::FrameQueue(const gpu::Device& device, Swapchain& swapchain)
    : device_(&device),
      swapchain_(&swapchain),
      pool_(device.handle(),
            vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device.queue_family())),
      most_in_flight_(std::min<size_t>(device.profile().most_frames_in_flight, frames_.size())),
      presents_late_(device.profile().presents_late) {
  const vk::CommandBufferAllocateInfo allocation(*pool_, vk::CommandBufferLevel::ePrimary, 1);
  for (Frame& frame : frames_) {
    frame.commands = std::move(vk::raii::CommandBuffers(device.handle(), allocation).front());
    frame.ready = vk::raii::Semaphore(device.handle(), vk::SemaphoreCreateInfo());
    frame.fence = vk::raii::Fence(device.handle(), vk::FenceCreateInfo());
    if (device.timestamp_period_ns() > 0.0) {
      frame.queries =
          vk::raii::QueryPool(device.handle(), vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, kMarkCount));
    }
    frame.counters.emplace(gpu::Buffer::make_readback(device, Film::kCountersBytes));
  }
}

bool FrameQueue::has_room() const {
  const auto count = std::count_if(frames_.begin(), frames_.end(), [](const Frame& f) { return f.is_in_flight; });
  return static_cast<size_t>(count) < most_in_flight_ && !frames_[next_].is_in_flight;
}

void FrameQueue::ask() {
  if (!asked_time_) asked_time_ = Window::now();
}

Frame* FrameQueue::begin() {
  ask();
  if (!has_room()) return nullptr;
  Frame& frame = frames_[next_];
  const std::optional<uint32_t> image = swapchain_->acquire(*frame.ready);
  if (!image) return nullptr;
  frame.image = *image;
  frame.begin_time = *std::exchange(asked_time_, std::nullopt);
  frame.units = 0.0;
  frame.has_list = false;
  frame.is_of_flight = false;
  frame.commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  if (*frame.queries) frame.commands.resetQueryPool(*frame.queries, 0, kMarkCount);
  frame.mark(FrameMark::kBegin);
  return &frame;
}

void FrameQueue::submit(Frame& frame) {
  frame.mark(FrameMark::kEnd);
  frame.commands.end();
  const vk::Semaphore wait = *frame.ready;
  const vk::PipelineStageFlags wait_stage = Stage::eColorAttachmentOutput;
  const vk::CommandBuffer commands = *frame.commands;
  const vk::Semaphore rendered = swapchain_->rendered(frame.image);
  const vk::SubmitInfo info(wait, wait_stage, commands, rendered);
  device_->use_queue([&](const vk::raii::Queue& queue) { queue.submit(info, *frame.fence); });
  frame.is_in_flight = true;
  frame.is_presented = !presents_late_;
  if (!presents_late_) swapchain_->present(frame.image);
  next_ = (next_ + 1) % frames_.size();
}

bool FrameQueue::is_idle() const {
  return std::none_of(frames_.begin(), frames_.end(), [](const Frame& f) { return f.is_in_flight; });
}

void FrameQueue::poll(const std::function<void(const FinishedFrame&)>& on_finished) {
  // The oldest first: the one that comes next is the one that was submitted longest ago.
  for (size_t i = 0; i < frames_.size(); ++i) {
    Frame& frame = frames_[(next_ + i) % frames_.size()];
    if (!frame.is_in_flight) continue;
    if (frame.fence.getStatus() != vk::Result::eSuccess) return;
    if (!frame.is_presented) swapchain_->present(frame.image);
    on_finished(take(frame));
  }
}

void FrameQueue::finish(const std::function<void(const FinishedFrame&)>& on_finished) {
  device_->wait_idle();
  poll(on_finished);
  // The image that was presented last belongs to the queue until the device is idle again.
  device_->wait_idle();
}

FinishedFrame FrameQueue::take(Frame& frame) {
  FinishedFrame finished;
  finished.stages = {stage_ms(frame, FrameMark::kBegin, FrameMark::kTraced),
                     stage_ms(frame, FrameMark::kTraced, FrameMark::kDisplayed),
                     stage_ms(frame, FrameMark::kDisplayed, FrameMark::kEnd)};
  finished.units = frame.units;
  finished.has_list = frame.has_list;
  finished.is_of_flight = frame.is_of_flight;
  if (frame.units > 0.0) {
    finished.rays = sum_counts(frame.counters->mapped());
    finished.has_cut_loops = were_loops_cut(frame.counters->mapped());
  }
  const double end_time = Window::now();
  finished.time_ms = 1e3 * (end_time - std::max(frame.begin_time, last_end_time_));
  last_end_time_ = end_time;
  device_->handle().resetFences({*frame.fence});
  frame.is_in_flight = false;
  if (frame.on_finished) std::exchange(frame.on_finished, {})(finished);
  return finished;
}

double FrameQueue::stage_ms(const Frame& frame, FrameMark from, FrameMark to) const {
  if (!*frame.queries) return 0.0;
  const auto get = [&](FrameMark mark) {
    return frame.queries
        .getResult<uint64_t>(static_cast<uint32_t>(mark), 1, sizeof(uint64_t), vk::QueryResultFlagBits::e64)
        .second;
  };
  return 1e-6 * device_->timestamp_period_ns() * static_cast<double>(device_->ticks_between(get(from), get(to)));
}

}  // namespace promin::app
