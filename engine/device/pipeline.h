// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "device/kernel_folder.h"
#include "device/shader_objects.h"
#include "device/spirv.h"
#include "promin/device.h"
#include "promin/math.h"

namespace promin::gpu {

class Buffer;
class Device;

/// A buffer at a binding (BINDING_* of shaders/shared/layout.h).
struct BoundBuffer {
  uint32_t binding = 0;
  vk::DescriptorType type = vk::DescriptorType::eStorageBuffer;
  const Buffer* buffer = nullptr;
  /// The view, if the buffer is read as texels.
  const vk::raii::BufferView* view = nullptr;
  /// True if Buffer::make_word_view() has made the view.
  bool has_word_view = false;
};

/// A compiled compute shader with entry point "main" and one descriptor set. It is not bound to buffers.
struct CompiledPipeline {
  vk::raii::DescriptorSetLayout set_layout{nullptr};
  vk::raii::PipelineLayout layout{nullptr};
  /// Null if the kernel is a shader object.
  vk::raii::Pipeline pipeline{nullptr};
  ShaderObject shader{nullptr};
};

/// The pipelines that a device has compiled. Two requests share a pipeline if specialize() returns the same code for
/// both and their bindings are equal. VkPipelineCache does not do this: lavapipe's is empty, and SwiftShader
/// distinguishes pipelines by their layout objects. Several threads may use this object; no thread waits while another
/// one compiles.
class CompiledPipelines {
 public:
  /// Makes kernels as shader objects from now on, and keeps their binaries in the folder. The device must have enabled
  /// shader_object_features().
  void keep_binaries(const vk::raii::PhysicalDevice& physical, std::filesystem::path folder);

  /// Returns a pipeline, and compiles it if needed. The pipeline is valid as long as this object exists. If the driver
  /// refuses the specialized code, it gets the module and the constants. Throws vk::SystemError, and std::logic_error
  /// if the module lacks a constant, which drivers silently ignore.
  const CompiledPipeline& get(const vk::raii::Device& device, std::span<const uint32_t> spirv,
                              std::span<const SpecializationConstant> constants,
                              std::span<const vk::DescriptorSetLayoutBinding> bindings);
  size_t size() const;
  /// Returns the counts and notes since the device was opened.
  KernelStats stats() const;

 private:
  ShaderObject make_shader_object(const vk::raii::Device& device, std::span<const uint32_t> key,
                                  std::span<const uint32_t> code, vk::DescriptorSetLayout layout);
  /// Counts a kernel that the driver has compiled, and adds a note unless it is empty.
  void count_compiled(const std::string& note = {});

  /// The folder of binaries, and the words at the begin of each of its keys.
  std::optional<KernelFolder> folder_;
  std::vector<uint32_t> binary_format_;
  mutable std::mutex mutex_;
  KernelStats stats_;
  /// The key holds the bindings and the specialized code.
  std::map<std::vector<uint32_t>, CompiledPipeline> compiled_;
};

/// A compiled pipeline and the buffers bound to it.
class ComputePipeline {
 public:
  /// Compiles the pipeline if needed, and binds the buffers. Throws the same exceptions as CompiledPipelines::get().
  ComputePipeline(const Device& device, std::span<const uint32_t> spirv,
                  std::span<const SpecializationConstant> constants, std::span<const BoundBuffer> buffers);

  /// Replaces the buffer of a binding that the constructor received. The device must be idle.
  void bind(const BoundBuffer& buffer);

  /// Records the bindings and a dispatch of `group_count` workgroups in x and y.
  void dispatch(const vk::raii::CommandBuffer& commands, const uvec2& group_count) const;
  /// Records a dispatch whose number of workgroups is in three words at `offset_bytes` of a buffer.
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
