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

/// A buffer with memory of its own. It lies in device-local memory; where the host can map that (integrated GPUs, CPU
/// devices) it is written and read directly, elsewhere through a staging buffer.
class Buffer {
 public:
  /// `size_bytes` > 0. Throws vk::SystemError, or RunError if the buffer could not be bound: a storage buffer beyond
  /// the device's maxStorageBufferRange that is not a texel buffer within its maxTexelBufferElements either. RunError
  /// too where a CPU driver keeps its memory in a file that would pass the process's file size limit.
  Buffer(const Device& device, vk::DeviceSize size_bytes, vk::BufferUsageFlags usage);

  /// The most bytes of a buffer for these uses.
  static vk::DeviceSize most_bytes(const Device& device, vk::BufferUsageFlags usage);

  /// One that transfers write and the host reads, at mapped().
  static Buffer make_readback(const Device& device, vk::DeviceSize size_bytes);

  const vk::raii::Buffer& handle() const { return buffer_; }
  vk::DeviceSize size_bytes() const { return size_bytes_; }

  /// Empty where the host cannot map it.
  std::span<const std::byte> mapped() const { return {mapped_, mapped_ == nullptr ? 0 : size_bytes_}; }

  /// The buffer, or as much of it as the device allows, as texels of four words.
  vk::raii::BufferView make_texel_view() const;
  /// A view of some of its bytes as words, as many as a view holds.
  vk::raii::BufferView make_word_view(vk::DeviceSize offset_bytes, vk::DeviceSize byte_count) const;

  /// Copies to the buffer and from it, at `offset_bytes` of it. The device is idle with respect to this buffer before
  /// and after.
  void write(std::span<const std::byte> data, vk::DeviceSize offset_bytes = 0);
  void read(std::span<std::byte> data, vk::DeviceSize offset_bytes = 0) const;
  /// The same without the caller's copy: `fill` writes all of `byte_count` bytes and `take` reads them, in place where
  /// the host can map the buffer. `byte_count` > 0.
  void write_by(const std::function<void(std::span<std::byte>)>& fill, vk::DeviceSize byte_count,
                vk::DeviceSize offset_bytes = 0);
  void read_by(const std::function<void(std::span<const std::byte>)>& take, vk::DeviceSize byte_count,
               vk::DeviceSize offset_bytes = 0) const;
  /// Copies the first bytes of another buffer to the start of this one; the device is idle with respect to both.
  void copy_from(const Buffer& other, vk::DeviceSize byte_count);

 private:
  Buffer(const Device& device, vk::DeviceSize size_bytes, vk::BufferUsageFlags usage,
         std::span<const vk::MemoryPropertyFlags> preferences);

  const Device* device_;
  vk::DeviceSize size_bytes_;
  vk::raii::Buffer buffer_{nullptr};
  vk::raii::DeviceMemory memory_{nullptr};
  /// Null where the host cannot map the memory.
  std::byte* mapped_ = nullptr;
};

/// For a new device: throws RunError where its driver keeps memory in a file that the process's file size limit keeps
/// so small that there is no room for what the driver allocates for itself.
void check_file_size_limit(const Device& device);

}  // namespace promin::gpu
