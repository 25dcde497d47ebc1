// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/side_compiler.h"

#include <bit>
#include <chrono>
#include <list>
#include <system_error>

#include "core/address_space.h"
#include "device/buffer.h"
#include "device/device.h"

namespace promin::gpu {
namespace {

/// A dispatch of kernels from the driver's cache takes 10 to 60 ms, and compiling a kernel of a picture 250 ms to 4 s.
constexpr std::chrono::milliseconds kPatience{150};

/// Larger than the head of a film, which kernels read whatever the size of the picture.
constexpr vk::DeviceSize kStandInBytes = 1U << 16;

vk::BufferUsageFlags usage_for(vk::DescriptorType type) {
  if (type == vk::DescriptorType::eUniformTexelBuffer) return vk::BufferUsageFlagBits::eUniformTexelBuffer;
  if (type == vk::DescriptorType::eUniformBuffer) return vk::BufferUsageFlagBits::eUniformBuffer;
  return vk::BufferUsageFlagBits::eStorageBuffer;
}

vk::DeviceSize size_for(const BoundBuffer& bound) {
  const vk::DeviceSize bytes = bound.buffer->size_bytes();
  // Uniform buffers are small, and their largest size may be that of a stand-in.
  if (bound.type == vk::DescriptorType::eUniformBuffer) return bytes;
  return kStandInBytes + (std::has_single_bit(bytes) ? 0 : kTexelBytes);
}

/// Buffers on another device that have the same kinds as the given ones. All bytes are zero, so a kernel finds no work.
class StandIns {
 public:
  StandIns(const Device& device, std::span<const BoundBuffer> buffers) {
    const std::vector<std::byte> zeros(2 * kStandInBytes);
    for (const BoundBuffer& bound : buffers) {
      const vk::DeviceSize bytes = size_for(bound);
      Buffer& buffer = buffers_.emplace_back(device, bytes, usage_for(bound.type));
      buffer.write(std::span(zeros).first(bytes));
      const bool is_texels = bound.view != nullptr;
      if (is_texels) views_.push_back(bound.has_word_view ? buffer.make_word_view(0, bytes) : buffer.make_texel_view());
      bound_.push_back({bound.binding, bound.type, &buffer, is_texels ? &views_.back() : nullptr, bound.has_word_view});
    }
  }

  std::span<const BoundBuffer> bound() const { return bound_; }

 private:
  // Lists, because elements of bound_ point into them.
  std::list<Buffer> buffers_;
  std::list<vk::raii::BufferView> views_;
  std::vector<BoundBuffer> bound_;
};

}  // namespace

void compile_on_second_device(const Device& device, const KernelSource& kernel) {
  // The driver's cache distinguishes kernels with a kept binary from others.
  const Device second(
      DeviceOptions{.selection = "uuid:" + device.info().uuid, .kernel_folder = device.kernel_folder()});
  const StandIns buffers(second, kernel.buffers);
  const ComputePipeline pipeline(second, kernel.spirv, kernel.constants, buffers.bound());
  second.run([&](const vk::raii::CommandBuffer& commands) { pipeline.dispatch(commands, uvec2(1)); });
  // The driver writes its cache in a thread, for which the end of the device waits.
}

SideCompiler::SideCompiler(const Device& device, const KernelSource& kernel) {
  if (!device.profile().compiles_on_second_device || address_space_limit()) return;
  try {
    thread_ = std::thread([this, &device, kernel] {
      {
        std::unique_lock lock(mutex_);
        if (has_ended_.wait_for(lock, kPatience, [&] { return is_ending_; })) return;
      }
      try {
        compile_on_second_device(device, kernel);
      } catch (const std::exception&) {
        // The first device compiles the kernel.
      }
    });
  } catch (const std::system_error&) {
    // No thread is available.
  }
}

SideCompiler::~SideCompiler() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  has_ended_.notify_all();
  thread_.join();
}

}  // namespace promin::gpu
