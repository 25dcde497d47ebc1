// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "device/device.h"

namespace promin::app {

/// Submits commands to a device, one list at a time, without waiting for it.
class DeviceWork {
 public:
  explicit DeviceWork(std::shared_ptr<const gpu::Device> device);
  /// Waits for the device if it is busy.
  ~DeviceWork();
  DeviceWork(const DeviceWork&) = delete;
  DeviceWork& operator=(const DeviceWork&) = delete;

  /// Begins to record commands; must not be called while busy.
  const vk::raii::CommandBuffer& begin();
  /// Records a timestamp at this point of the commands; at most kMostMarks times.
  void mark();
  /// Submits the recorded commands. They wait for a semaphore and signal one, if these are not null.
  void submit(vk::Semaphore wait = {}, vk::Semaphore signal = {});
  /// Discards the recorded commands.
  void drop() { commands_.end(); }

  bool is_busy() const { return is_busy_; }
  /// Returns whether the submitted commands have finished. It returns true only once for each submission.
  bool take_finished();
  /// Returns the milliseconds between a mark and the next mark in the commands that finished last; 0 if the device has
  /// no timestamps.
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
