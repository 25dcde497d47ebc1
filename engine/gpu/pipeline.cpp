// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "gpu/pipeline.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/device.h"

namespace promin::gpu {

bool has_specialization_constant(std::span<const uint32_t> spirv, uint32_t id) {
  constexpr size_t kHeaderWords = 5;
  constexpr uint32_t kOpDecorate = 71;
  constexpr uint32_t kSpecId = 1;
  for (size_t i = kHeaderWords; i < spirv.size();) {
    const uint32_t opcode = spirv[i] & 0xFFFFU;
    const uint32_t length = spirv[i] >> 16;
    if (length == 0) return false;
    if (opcode == kOpDecorate && length >= 4 && spirv[i + 2] == kSpecId && spirv[i + 3] == id) return true;
    i += length;
  }
  return false;
}

ComputePipeline::ComputePipeline(const Device& device, std::span<const uint32_t> spirv,
                                 std::span<const SpecializationConstant> constants,
                                 std::span<const BoundBuffer> buffers)
    : device_(&device) {
  const vk::raii::Device& handle = device.handle();

  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  std::map<vk::DescriptorType, uint32_t> type_counts;
  for (const BoundBuffer& buffer : buffers) {
    bindings.emplace_back(buffer.binding, buffer.type, 1, vk::ShaderStageFlagBits::eCompute);
    ++type_counts[buffer.type];
  }
  std::vector<vk::DescriptorPoolSize> pool_sizes;
  for (const auto& [type, count] : type_counts) pool_sizes.emplace_back(type, count);
  set_layout_ = vk::raii::DescriptorSetLayout(handle, vk::DescriptorSetLayoutCreateInfo({}, bindings));
  pool_ = vk::raii::DescriptorPool(
      handle, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, pool_sizes));
  set_ = std::move(vk::raii::DescriptorSets(handle, vk::DescriptorSetAllocateInfo(*pool_, *set_layout_)).front());
  for (const BoundBuffer& buffer : buffers) bind(buffer);

  layout_ = vk::raii::PipelineLayout(handle, vk::PipelineLayoutCreateInfo({}, *set_layout_));

  std::vector<vk::SpecializationMapEntry> entries;
  std::vector<uint32_t> values;
  for (const SpecializationConstant& constant : constants) {
    if (!has_specialization_constant(spirv, constant.id)) {
      throw std::logic_error("the shader has no specialisation constant " + std::to_string(constant.id));
    }
    entries.emplace_back(constant.id, static_cast<uint32_t>(values.size() * sizeof(uint32_t)), sizeof(uint32_t));
    values.push_back(constant.value);
  }
  const vk::SpecializationInfo specialization(static_cast<uint32_t>(entries.size()), entries.data(),
                                              values.size() * sizeof(uint32_t), values.data());
  const vk::raii::ShaderModule module(handle, vk::ShaderModuleCreateInfo({}, spirv.size_bytes(), spirv.data()));
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main",
                                                &specialization);
  pipeline_ = vk::raii::Pipeline(handle, device.pipeline_cache(), vk::ComputePipelineCreateInfo({}, stage, *layout_));
}

void ComputePipeline::bind(const BoundBuffer& buffer) {
  vk::WriteDescriptorSet write(*set_, buffer.binding, 0, 1, buffer.type);
  // What lies beyond the range of a storage buffer, the shader reads as texels.
  const vk::DeviceSize range =
      std::min<vk::DeviceSize>(buffer.buffer->size_bytes(), device_->limits().maxStorageBufferRange);
  const vk::DescriptorBufferInfo info(*buffer.buffer->handle(), 0, range);
  vk::BufferView view;
  if (buffer.view != nullptr) {
    view = **buffer.view;
    write.pTexelBufferView = &view;
  } else {
    write.pBufferInfo = &info;
  }
  device_->handle().updateDescriptorSets(write, {});
}

void ComputePipeline::dispatch(const vk::raii::CommandBuffer& commands, uint32_t group_count) const {
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, *set_, {});
  commands.dispatch(group_count, 1, 1);
}

}  // namespace promin::gpu
