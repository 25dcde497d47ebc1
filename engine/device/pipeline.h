// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "device/spirv.h"
#include "promin/math.h"

namespace promin::gpu {

class Buffer;
class Device;

/// A buffer at a binding (BINDING_* of shaders/shared/layout.h).
struct BoundBuffer {
  uint32_t binding = 0;
  vk::DescriptorType type = vk::DescriptorType::eStorageBuffer;
  const Buffer* buffer = nullptr;
  /// The view of a texel buffer.
  const vk::raii::BufferView* view = nullptr;
};

/// A compiled compute shader with entry point "main" and one descriptor set, without its bindings.
struct CompiledPipeline {
  vk::raii::DescriptorSetLayout set_layout{nullptr};
  vk::raii::PipelineLayout layout{nullptr};
  vk::raii::Pipeline pipeline{nullptr};
};

/// The pipelines that a device has compiled. Two requests share one where the same code is left of their shaders
/// (specialize) and their bindings are equal. VkPipelineCache does not do this: lavapipe's is empty, and SwiftShader
/// distinguishes pipelines by their layout objects. Several threads can use it; none waits while another compiles.
class CompiledPipelines {
 public:
  /// Returns a pipeline, and compiles it if needed. It is valid as long as this object. Throws vk::SystemError, and
  /// std::logic_error if the module lacks a constant, which drivers silently ignore.
  const CompiledPipeline& get(const vk::raii::Device& device, std::span<const uint32_t> spirv,
                              std::span<const SpecializationConstant> constants,
                              std::span<const vk::DescriptorSetLayoutBinding> bindings);
  size_t size() const;

 private:
  mutable std::mutex mutex_;
  /// The key holds the bindings and the specialized code.
  std::map<std::vector<uint32_t>, CompiledPipeline> compiled_;
};

/// A compiled pipeline and the buffers bound to it.
class ComputePipeline {
 public:
  /// Throws as CompiledPipelines::get does.
  ComputePipeline(const Device& device, std::span<const uint32_t> spirv,
                  std::span<const SpecializationConstant> constants, std::span<const BoundBuffer> buffers);

  /// Changes what a binding of the constructor refers to; the device must be idle.
  void bind(const BoundBuffer& buffer);

  /// Records binding everything and `group_count` workgroups, across and down.
  void dispatch(const vk::raii::CommandBuffer& commands, const uvec2& group_count) const;
  /// Does the same with the number of workgroups in three words at `offset_bytes` of a buffer.
  void dispatch_indirect(const vk::raii::CommandBuffer& commands, const Buffer& group_count,
                         vk::DeviceSize offset_bytes) const;

 private:
  void bind_all(const vk::raii::CommandBuffer& commands) const;

  const Device* device_;
  const CompiledPipeline* compiled_;
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
};

}  // namespace promin::gpu
