// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/buffer.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <optional>
#include <string>

#include "device/device.h"
#include "promin/error.h"

namespace promin::gpu {
namespace {

using Memory = vk::MemoryPropertyFlagBits;
constexpr vk::MemoryPropertyFlags kMappable = Memory::eHostVisible | Memory::eHostCoherent;

// Reading pictures back needs cached memory. On discrete GPUs, device-local mappable memory is not cached and may be
// small, so they use staging buffers.
const std::array kDevicePreferences{Memory::eDeviceLocal | kMappable | Memory::eHostCached,
                                    vk::MemoryPropertyFlags(Memory::eDeviceLocal), vk::MemoryPropertyFlags()};
const std::array kStagingPreferences{kMappable | Memory::eHostCached, kMappable};

/// Returns the file size limit in bytes; nullopt if there is no limit.
std::optional<rlim_t> file_size_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

/// Checks the last byte of device memory with a read by the kernel. Some CPU drivers keep device memory in a file
/// (lavapipe from Mesa 24.3 on) and do not notice if the file size limit keeps it from growing. The first access by the
/// program would then end it with SIGBUS, but a read by the kernel only fails. Throws RunError.
void check_memory_is_there(const std::byte* last_byte) {
  const std::optional<rlim_t> limit = file_size_limit();
  std::array<int, 2> pipe_ends{};
  if (!limit || pipe2(pipe_ends.data(), O_CLOEXEC) != 0) return;
  const bool is_there = ::write(pipe_ends[1], last_byte, 1) == 1;
  for (const int end : pipe_ends) close(end);
  if (is_there) return;
  throw RunError({"device.memory.file",
                  "the driver keeps device memory in a file, which cannot grow beyond the file size limit of " +
                      std::to_string(*limit) + " bytes",
                  "", "raise the limit (ulimit -f)"});
}

}  // namespace

Buffer::Buffer(const Device& device, vk::DeviceSize size_bytes, vk::BufferUsageFlags usage)
    : Buffer(device, size_bytes, usage | vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst,
             kDevicePreferences) {}

Buffer::Buffer(const Device& device, vk::DeviceSize size_bytes, vk::BufferUsageFlags usage,
               std::span<const vk::MemoryPropertyFlags> preferences)
    : device_(&device), size_bytes_(size_bytes) {
  const vk::DeviceSize most = most_bytes(device, usage);
  if (size_bytes > most) {
    throw RunError({"device.buffer.large",
                    "the scene needs a buffer of " + std::to_string(size_bytes >> 20) + " MiB, and the device allows " +
                        std::to_string(most >> 20) + " MiB",
                    "", "use a smaller scene or another device", Setting::kDevice});
  }
  buffer_ = vk::raii::Buffer(device.handle(), vk::BufferCreateInfo({}, size_bytes, usage));
  const vk::MemoryRequirements requirements = buffer_.getMemoryRequirements();
  std::optional<uint32_t> type;
  vk::MemoryPropertyFlags properties;
  for (const auto& wanted : preferences) {
    type = device.find_memory_type(requirements.memoryTypeBits, wanted);
    properties = wanted;
    if (type) break;
  }
  // Vulkan guarantees that every buffer has a host-visible coherent memory type, and at least one type.
  assert(type.has_value());
  memory_ = vk::raii::DeviceMemory(device.handle(), vk::MemoryAllocateInfo(requirements.size, *type));
  buffer_.bindMemory(*memory_, 0);
  if ((properties & kMappable) == kMappable) {
    mapped_ = static_cast<std::byte*>(memory_.mapMemory(0, VK_WHOLE_SIZE));
    check_memory_is_there(mapped_ + requirements.size - 1);
  }
}

void check_file_size_limit(const Device& device) {
  // More memory than a driver needs in addition to buffers. The driver's later allocations reuse this space.
  constexpr vk::DeviceSize kDriverBytes = 1U << 20;
  if (file_size_limit()) Buffer(device, kDriverBytes, vk::BufferUsageFlagBits::eTransferDst);
}

vk::DeviceSize Buffer::most_bytes(const Device& device, vk::BufferUsageFlags usage) {
  const vk::PhysicalDeviceLimits& limits = device.limits();
  vk::DeviceSize most = ~vk::DeviceSize{0};
  if (usage & vk::BufferUsageFlagBits::eStorageBuffer) most = limits.maxStorageBufferRange;
  if (usage & vk::BufferUsageFlagBits::eUniformTexelBuffer) {
    most = std::max(most, limits.maxTexelBufferElements * kTexelBytes);
  }
  return most;
}

Buffer Buffer::make_readback(const Device& device, vk::DeviceSize size_bytes) {
  return {device, size_bytes, vk::BufferUsageFlagBits::eTransferDst, kStagingPreferences};
}

vk::raii::BufferView Buffer::make_texel_view() const {
  const vk::DeviceSize most_bytes = device_->limits().maxTexelBufferElements * kTexelBytes;
  return {device_->handle(),
          vk::BufferViewCreateInfo({}, *buffer_, vk::Format::eR32G32B32A32Uint, 0, std::min(size_bytes_, most_bytes))};
}

vk::raii::BufferView Buffer::make_word_view(vk::DeviceSize offset_bytes, vk::DeviceSize byte_count) const {
  const vk::DeviceSize most_bytes = device_->limits().maxTexelBufferElements * sizeof(uint32_t);
  return {device_->handle(),
          vk::BufferViewCreateInfo({}, *buffer_, vk::Format::eR32Uint, offset_bytes, std::min(byte_count, most_bytes))};
}

void Buffer::write(std::span<const std::byte> data, vk::DeviceSize offset_bytes) {
  if (data.empty()) return;
  const auto fill = [&](std::span<std::byte> bytes) { std::memcpy(bytes.data(), data.data(), data.size()); };
  write_by(fill, data.size(), offset_bytes);
}

void Buffer::read(std::span<std::byte> data, vk::DeviceSize offset_bytes) const {
  if (data.empty()) return;
  const auto take = [&](std::span<const std::byte> bytes) { std::memcpy(data.data(), bytes.data(), data.size()); };
  read_by(take, data.size(), offset_bytes);
}

void Buffer::write_by(const std::function<void(std::span<std::byte>)>& fill, vk::DeviceSize byte_count,
                      vk::DeviceSize offset_bytes) {
  assert(byte_count > 0 && offset_bytes + byte_count <= size_bytes_);
  if (mapped_ != nullptr) {
    fill({mapped_ + offset_bytes, byte_count});
    return;
  }
  const Buffer staging(*device_, byte_count, vk::BufferUsageFlagBits::eTransferSrc, kStagingPreferences);
  fill({staging.mapped_, byte_count});
  device_->run([&](const vk::raii::CommandBuffer& commands) {
    commands.copyBuffer(*staging.buffer_, *buffer_, vk::BufferCopy(0, offset_bytes, byte_count));
  });
}

void Buffer::read_by(const std::function<void(std::span<const std::byte>)>& take, vk::DeviceSize byte_count,
                     vk::DeviceSize offset_bytes) const {
  assert(byte_count > 0 && offset_bytes + byte_count <= size_bytes_);
  if (mapped_ != nullptr) {
    take({mapped_ + offset_bytes, byte_count});
    return;
  }
  const Buffer staging = make_readback(*device_, byte_count);
  device_->run([&](const vk::raii::CommandBuffer& commands) {
    const vk::MemoryBarrier before(vk::AccessFlagBits::eShaderWrite, vk::AccessFlagBits::eTransferRead);
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader, vk::PipelineStageFlagBits::eTransfer, {},
                             before, {}, {});
    commands.copyBuffer(*buffer_, *staging.buffer_, vk::BufferCopy(offset_bytes, 0, byte_count));
    const vk::MemoryBarrier after(vk::AccessFlagBits::eTransferWrite, vk::AccessFlagBits::eHostRead);
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost, {}, after, {}, {});
  });
  take({staging.mapped_, byte_count});
}

void Buffer::copy_from(const Buffer& other, vk::DeviceSize byte_count) {
  assert(byte_count <= size_bytes_ && byte_count <= other.size_bytes_);
  if (byte_count == 0) return;
  if (mapped_ != nullptr && other.mapped_ != nullptr) {
    std::memcpy(mapped_, other.mapped_, byte_count);
    return;
  }
  device_->run([&](const vk::raii::CommandBuffer& commands) {
    commands.copyBuffer(*other.buffer_, *buffer_, vk::BufferCopy(0, 0, byte_count));
  });
}

}  // namespace promin::gpu
