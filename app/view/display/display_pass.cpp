// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/display/display_pass.h"

#include <array>

#include "cover_window.spv.h"
#include "display.spv.h"

namespace promin::app {
namespace {

/// The push constants of shaders/window/display.frag.
struct DisplayConstants {
  uvec4 size;
  vec4 scale;
};
constexpr uint32_t kDecodes = 0;
template <size_t N>
vk::raii::ShaderModule make_module(const gpu::Device& device, const uint32_t (&spirv)[N]) {
  return {device.handle(), vk::ShaderModuleCreateInfo({}, sizeof spirv, spirv)};
}

vk::raii::Pipeline make_pipeline(const gpu::Device& device, const Swapchain& swapchain, vk::PipelineLayout layout) {
  const vk::raii::ShaderModule vertex = make_module(device, k_cover_window_spirv);
  const vk::raii::ShaderModule fragment = make_module(device, k_display_spirv);
  const uint32_t decodes = swapchain.encodes() ? 1 : 0;
  const vk::SpecializationMapEntry entry(kDecodes, 0, sizeof decodes);
  const vk::SpecializationInfo specialization(1, &entry, sizeof decodes, &decodes);
  const std::array stages{
      vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eVertex, *vertex, "main"),
      vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eFragment, *fragment, "main", &specialization)};
  const vk::PipelineVertexInputStateCreateInfo no_vertices;
  const vk::PipelineInputAssemblyStateCreateInfo triangles({}, vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  vk::PipelineRasterizationStateCreateInfo filled;
  filled.lineWidth = 1.0F;
  const vk::PipelineMultisampleStateCreateInfo single({}, vk::SampleCountFlagBits::e1);
  vk::PipelineColorBlendAttachmentState replace;
  using Color = vk::ColorComponentFlagBits;
  replace.colorWriteMask = Color::eR | Color::eG | Color::eB | Color::eA;
  const vk::PipelineColorBlendStateCreateInfo blend({}, VK_FALSE, vk::LogicOp::eCopy, replace);
  const std::array changing{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamic({}, changing);
  return {device.handle(), nullptr,
          vk::GraphicsPipelineCreateInfo({}, stages, &no_vertices, &triangles, nullptr, &viewport, &filled, &single,
                                         nullptr, &blend, &dynamic, layout, *swapchain.render_pass(), 0)};
}

}  // namespace

DisplayPass::DisplayPass(const gpu::Device& device, const Swapchain& swapchain) : device_(&device) {
  constexpr auto kStage = vk::ShaderStageFlagBits::eFragment;
  constexpr auto kType = vk::DescriptorType::eStorageBuffer;
  const vk::DescriptorSetLayoutBinding encoded(0, kType, 1, kStage);
  set_layout_ = vk::raii::DescriptorSetLayout(device.handle(), vk::DescriptorSetLayoutCreateInfo({}, encoded));
  const vk::PushConstantRange constants(kStage, 0, sizeof(DisplayConstants));
  layout_ = vk::raii::PipelineLayout(device.handle(), vk::PipelineLayoutCreateInfo({}, *set_layout_, constants));
  pipeline_ = make_pipeline(device, swapchain, *layout_);
  const vk::DescriptorPoolSize size(kType, 1);
  pool_ = vk::raii::DescriptorPool(
      device.handle(), vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, size));
  const vk::DescriptorSetAllocateInfo allocation(*pool_, *set_layout_);
  set_ = std::move(vk::raii::DescriptorSets(device.handle(), allocation).front());
}

void DisplayPass::take(const EncodedPicture& picture) {
  const vk::DeviceSize size = vk::DeviceSize{picture.size.x} * picture.size.y * sizeof(uint32_t);
  if (!encoded_ || encoded_->size_bytes() < size) {
    encoded_.emplace(*device_, size, vk::BufferUsageFlagBits::eStorageBuffer);
    const vk::DescriptorBufferInfo info(*encoded_->handle(), 0, VK_WHOLE_SIZE);
    vk::WriteDescriptorSet write(*set_, 0, 0, 1, vk::DescriptorType::eStorageBuffer);
    write.pBufferInfo = &info;
    device_->handle().updateDescriptorSets(write, {});
  }
  encoded_->write(std::as_bytes(picture.words).first(size));
  encoded_size_ = picture.size;
}

void DisplayPass::record_drawing(const vk::raii::CommandBuffer& commands, const uvec2& window_size) const {
  if (!encoded_size_) return;
  const DisplayConstants constants{uvec4(*encoded_size_, 0, 0),
                                   vec4(vec2(*encoded_size_) / vec2(window_size), 0.0F, 0.0F)};
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 0, *set_, {});
  commands.pushConstants<DisplayConstants>(*layout_, vk::ShaderStageFlagBits::eFragment, 0, constants);
  commands.setViewport(0, vk::Viewport(0, 0, static_cast<float>(window_size.x), static_cast<float>(window_size.y)));
  commands.setScissor(0, vk::Rect2D({0, 0}, {window_size.x, window_size.y}));
  commands.draw(3, 1, 0, 0);
}

}  // namespace promin::app
