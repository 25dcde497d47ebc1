// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/display_pass.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/divide_up.h"
#include "cover_window.spv.h"
#include "display.spv.h"
#include "encode_film.spv.h"
#include "layout.h"

namespace promin::app {
namespace {

/// The push constants of shaders/display.frag.
struct DisplayConstants {
  uvec4 size;
  vec4 scale;
};
constexpr uint32_t kDecodes = 0;
/// Constants of shaders/encode_film.comp.
constexpr uint32_t kToneMapping = 0;
constexpr uint32_t kExposure = 1;
constexpr uint32_t kDithers = 2;
constexpr uint32_t kHasUnlit = 3;
constexpr uint32_t kEncodedBinding = 0;

/// Most workgroups that encode a film: enough for any device, each takes its share.
constexpr uint32_t kMostEncodingGroups = 1024;

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

gpu::ComputePipeline make_encoder(const gpu::Device& device, const gpu::Buffer& film, const gpu::Buffer& encoded,
                                  const DisplayTransform& display, bool has_unlit) {
  const std::array constants{
      gpu::SpecializationConstant{kToneMapping, static_cast<uint32_t>(display.tone_mapping)},
      gpu::SpecializationConstant{kExposure, std::bit_cast<uint32_t>(std::exp2(display.exposure_ev))},
      gpu::SpecializationConstant{kDithers, display.dithers ? 1U : 0U},
      gpu::SpecializationConstant{kHasUnlit, has_unlit ? 1U : 0U}};
  constexpr auto kStorage = vk::DescriptorType::eStorageBuffer;
  const std::array buffers{gpu::BoundBuffer{layout::BINDING_FILM, kStorage, &film},
                           gpu::BoundBuffer{kEncodedBinding, kStorage, &encoded}};
  return {device, k_encode_film_spirv, constants, buffers};
}

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

void DisplayPass::bind(std::array<const gpu::Buffer*, kFilmCount> films, uint32_t pixel_count,
                       const DisplayTransform& display, bool has_unlit) {
  constexpr auto kStorage = vk::DescriptorType::eStorageBuffer;
  const vk::DeviceSize size = pixel_count * sizeof(uint32_t);
  if (!encoded_ || encoded_->size_bytes() < size) {
    gpu::Buffer larger(*device_, size, vk::BufferUsageFlagBits::eStorageBuffer);
    if (encoded_size_) {
      device_->run([&](const vk::raii::CommandBuffer& commands) {
        commands.copyBuffer(*encoded_->handle(), *larger.handle(), vk::BufferCopy(0, 0, encoded_->size_bytes()));
      });
    }
    encoded_ = std::move(larger);
    const vk::DescriptorBufferInfo info(*encoded_->handle(), 0, VK_WHOLE_SIZE);
    vk::WriteDescriptorSet write(*set_, 0, 0, 1, kStorage);
    write.pBufferInfo = &info;
    device_->handle().updateDescriptorSets(write, {});
  }
  for (size_t i = 0; i < kFilmCount; ++i)
    encoders_[i].emplace(make_encoder(*device_, *films[i], *encoded_, display, has_unlit));
}

void DisplayPass::record_encoding(const vk::raii::CommandBuffer& commands, const ShownPicture& picture) {
  using Access = vk::AccessFlagBits;
  using Stage = vk::PipelineStageFlagBits;
  const vk::MemoryBarrier traced(Access::eShaderWrite | Access::eTransferWrite, Access::eShaderRead);
  // The frame before may still draw what was encoded before.
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer | Stage::eFragmentShader, Stage::eComputeShader, {},
                           traced, {}, {});
  constexpr uint32_t kLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;
  const uint32_t groups = divide_up(picture.size.x * picture.size.y, kLanes);
  encoders_[picture.film]->dispatch(commands, uvec2(std::min(groups, kMostEncodingGroups), 1));
  const vk::MemoryBarrier encoded(Access::eShaderWrite, Access::eShaderRead);
  commands.pipelineBarrier(Stage::eComputeShader, Stage::eFragmentShader, {}, encoded, {}, {});
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
