// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "device/device.h"

namespace promin::app {

/// Commands that a device is given, one list at a time, without waiting for it.
class DeviceWork {
 public:
  explicit DeviceWork(std::shared_ptr<const gpu::Device> device);
  /// Waits for the device where it is busy.
  ~DeviceWork();
  DeviceWork(const DeviceWork&) = delete;
  DeviceWork& operator=(const DeviceWork&) = delete;

  /// Begins to record; must not be called while busy.
  const vk::raii::CommandBuffer& begin();
  /// Takes the time at this place of the commands; kMostMarks at most.
  void mark();
  /// Hands over what was recorded. It waits for a semaphore and signals one, where they are not null.
  void submit(vk::Semaphore wait = {}, vk::Semaphore signal = {});
  /// Drops what was recorded.
  void drop() { commands_.end(); }

  bool is_busy() const { return is_busy_; }
  /// Whether what was submitted is finished: true once.
  bool take_finished();
  /// Milliseconds between a mark and the next, of what finished last; 0 where the device has no timestamps.
  double ms_after(uint32_t mark) const;

  static constexpr uint32_t kMostMarks = 4;

 private:
  std::shared_ptr<const gpu::Device> device_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffer commands_{nullptr};
  vk::raii::Fence fence_;
  vk::raii::QueryPool queries_{nullptr};
  uint32_t mark_count_ = 0;
  bool is_busy_ = false;
};

}  // namespace promin::app
