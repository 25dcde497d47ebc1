// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vulkan/vulkan_raii.hpp>

namespace promin::gpu {

class Buffer;
class Device;

/// A specialisation constant: `id` is a CONSTANT_* of shaders/layout.h.
struct SpecializationConstant {
  uint32_t id = 0;
  uint32_t value = 0;
};

/// A buffer at a binding (BINDING_* of shaders/layout.h).
struct BoundBuffer {
  uint32_t binding = 0;
  vk::DescriptorType type = vk::DescriptorType::eStorageBuffer;
  const Buffer* buffer = nullptr;
  /// Of a texel buffer, its view.
  const vk::raii::BufferView* view = nullptr;
};

/// Whether a SPIR-V module declares a specialisation constant with this SpecId.
bool has_specialization_constant(std::span<const uint32_t> spirv, uint32_t id);

/// A compute pipeline with entry point "main" and one descriptor set.
class ComputePipeline {
 public:
  /// Throws vk::SystemError, and std::logic_error if the module lacks a constant: a driver would ignore it in silence.
  ComputePipeline(const Device& device, std::span<const uint32_t> spirv,
                  std::span<const SpecializationConstant> constants, std::span<const BoundBuffer> buffers);

  /// Changes what a binding of the constructor refers to; the device must be idle.
  void bind(const BoundBuffer& buffer);

  /// Records binding everything and `group_count` workgroups.
  void dispatch(const vk::raii::CommandBuffer& commands, uint32_t group_count) const;

 private:
  const Device* device_;
  vk::raii::DescriptorSetLayout set_layout_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
  vk::raii::Pipeline pipeline_{nullptr};
};

}  // namespace promin::gpu
