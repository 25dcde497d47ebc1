// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vulkan/vulkan_raii.hpp>

namespace promin::gpu {

class Device;

/// Bytes of a texel: R32G32B32A32_UINT.
inline constexpr vk::DeviceSize kTexelBytes = 16;

/// A buffer with its own device-local memory. If the host can map that memory (integrated GPUs, CPU devices), it is
/// written and read directly, else through a staging buffer.
class Buffer {
 public:
  /// `size_bytes` > 0. Throws vk::SystemError, or RunError if the buffer could not be bound: a storage buffer beyond
  /// the device's maxStorageBufferRange that is not a texel buffer within its maxTexelBufferElements either. Also
  /// throws RunError if a CPU driver keeps its memory in a file that would exceed the process's file size limit.
  Buffer(const Device& device, vk::DeviceSize size_bytes, vk::BufferUsageFlags usage);

  /// Returns the largest size in bytes of a buffer for these uses.
  static vk::DeviceSize most_bytes(const Device& device, vk::BufferUsageFlags usage);

  /// Creates a buffer that transfers write and the host reads at mapped().
  static Buffer make_readback(const Device& device, vk::DeviceSize size_bytes);

  const vk::raii::Buffer& handle() const { return buffer_; }
  vk::DeviceSize size_bytes() const { return size_bytes_; }

  /// Returns the memory; empty if the host cannot map it.
  std::span<const std::byte> mapped() const { return {mapped_, mapped_ == nullptr ? 0 : size_bytes_}; }

  /// Returns a view of the buffer, or of as much as the device allows, as texels of four words.
  vk::raii::BufferView make_texel_view() const;
  /// Returns a view of its bytes from an offset on as words, as many as a view can hold.
  vk::raii::BufferView make_word_view(vk::DeviceSize offset_bytes, vk::DeviceSize byte_count) const;

  /// Copies data to or from the buffer at `offset_bytes`. The device does not use this buffer before and after.
  void write(std::span<const std::byte> data, vk::DeviceSize offset_bytes = 0);
  void read(std::span<std::byte> data, vk::DeviceSize offset_bytes = 0) const;
  /// Does the same without a copy by the caller: `fill` writes all `byte_count` bytes and `take` reads them, in place
  /// if the host can map the buffer. `byte_count` > 0.
  void write_by(const std::function<void(std::span<std::byte>)>& fill, vk::DeviceSize byte_count,
                vk::DeviceSize offset_bytes = 0);
  void read_by(const std::function<void(std::span<const std::byte>)>& take, vk::DeviceSize byte_count,
               vk::DeviceSize offset_bytes = 0) const;
  /// Copies the first bytes of another buffer to the start of this one; the device uses neither of them.
  void copy_from(const Buffer& other, vk::DeviceSize byte_count);

 private:
  Buffer(const Device& device, vk::DeviceSize size_bytes, vk::BufferUsageFlags usage,
         std::span<const vk::MemoryPropertyFlags> preferences);

  const Device* device_;
  vk::DeviceSize size_bytes_;
  vk::raii::Buffer buffer_{nullptr};
  vk::raii::DeviceMemory memory_{nullptr};
  /// Null if the host cannot map the memory.
  std::byte* mapped_ = nullptr;
};

/// Checks a new device: throws RunError if its driver keeps memory in a file and the process's file size limit leaves
/// no room for the driver's own allocations.
void check_file_size_limit(const Device& device);

}  // namespace promin::gpu
