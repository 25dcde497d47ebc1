// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vulkan/vulkan_raii.hpp>

namespace promin::gpu {

class Device;

/// Number of bytes of a texel with the format R32G32B32A32_UINT.
inline constexpr vk::DeviceSize kTexelBytes = 16;

/// A buffer with its own device-local memory. If the host can map the memory (integrated GPUs, CPU devices), the buffer
/// is written and read directly, otherwise through a staging buffer.
class Buffer {
 public:
  /// Creates a buffer; `size_bytes` > 0. Throws vk::SystemError. Throws RunError if the buffer could not be bound: if
  /// it exceeds maxStorageBufferRange as a storage buffer, and is no texel buffer within maxTexelBufferElements. Also
  /// throws RunError if a CPU driver keeps memory in a file that would exceed the process's file size limit.
  Buffer(const Device& device, vk::DeviceSize size_bytes, vk::BufferUsageFlags usage);

  /// Returns the largest size in bytes of a buffer for these uses.
  static vk::DeviceSize most_bytes(const Device& device, vk::BufferUsageFlags usage);

  /// Creates a buffer that transfers write and that the host reads at mapped().
  static Buffer make_readback(const Device& device, vk::DeviceSize size_bytes);

  const vk::raii::Buffer& handle() const { return buffer_; }
  vk::DeviceSize size_bytes() const { return size_bytes_; }

  /// Returns the memory; empty if the host cannot map it.
  std::span<const std::byte> mapped() const { return {mapped_, mapped_ == nullptr ? 0 : size_bytes_}; }

  /// Returns a view of the buffer as texels of four words. The view ends earlier if the device allows no larger view.
  vk::raii::BufferView make_texel_view() const;
  /// Returns a view of the buffer's bytes from an offset on, as words. The view has as many words as a view can hold.
  vk::raii::BufferView make_word_view(vk::DeviceSize offset_bytes, vk::DeviceSize byte_count) const;

  /// Copies data to or from the buffer at `offset_bytes`. The device must not use the buffer during the call.
  void write(std::span<const std::byte> data, vk::DeviceSize offset_bytes = 0);
  void read(std::span<std::byte> data, vk::DeviceSize offset_bytes = 0) const;
  /// Writes or reads without a copy by the caller: `fill` writes all `byte_count` bytes, and `take` reads them, in
  /// place if the host can map the buffer. `byte_count` > 0.
  void write_by(const std::function<void(std::span<std::byte>)>& fill, vk::DeviceSize byte_count,
                vk::DeviceSize offset_bytes = 0);
  void read_by(const std::function<void(std::span<const std::byte>)>& take, vk::DeviceSize byte_count,
               vk::DeviceSize offset_bytes = 0) const;
  /// Copies the first bytes of another buffer to the start of this buffer. The device must not use either buffer.
  void copy_from(const Buffer& other, vk::DeviceSize byte_count);

 private:
  Buffer(const Device& device, vk::DeviceSize size_bytes, vk::BufferUsageFlags usage,
         std::span<const vk::MemoryPropertyFlags> preferences);

  const Device* device_;
  vk::DeviceSize size_bytes_;
  vk::raii::Buffer buffer_{nullptr};
  vk::raii::DeviceMemory memory_{nullptr};
  /// Address of the mapped memory; null if the host cannot map the memory.
  std::byte* mapped_ = nullptr;
};

/// Checks a new device. Throws RunError if its driver keeps memory in a file and the process's file size limit leaves
/// no space for the driver's own allocations.
void check_file_size_limit(const Device& device);

}  // namespace promin::gpu
