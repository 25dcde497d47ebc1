// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/device_scene.h"

#include <algorithm>

#include "device/device.h"

namespace promin {
namespace {

constexpr vk::BufferUsageFlags kStorage = vk::BufferUsageFlagBits::eStorageBuffer;
constexpr vk::BufferUsageFlags kStorageOrTexels = kStorage | vk::BufferUsageFlagBits::eUniformTexelBuffer;

gpu::Buffer upload(const gpu::Device& device, std::span<const std::byte> bytes, vk::BufferUsageFlags usage) {
  gpu::Buffer buffer(device, bytes.size(), usage);
  buffer.write(bytes);
  return buffer;
}

}  // namespace

DeviceScene::DeviceScene(const gpu::Device& device, const PackedScene& packed)
    : nodes_(upload(device, std::as_bytes(packed.tree().nodes), kStorageOrTexels)),
      primitives_(upload(device, std::as_bytes(std::span(packed.primitives)), kStorageOrTexels)),
      node_texels_(nodes_.make_texel_view()),
      primitive_texels_(primitives_.make_texel_view()),
      shading_(upload(device, packed.shading, kStorageOrTexels)),
      shading_texels_(shading_.make_texel_view()),
      frame_(packed.frame),
      dispatch_(packed.dispatch),
      // In steps, so that scenes of about the same depth share pipelines.
      stack_size_((packed.stack_size + 7) / 8 * 8),
      fetches_texels_(std::max({nodes_.size_bytes(), primitives_.size_bytes(), shading_.size_bytes()}) <=
                      device.limits().maxTexelBufferElements * gpu::kTexelBytes) {}

std::vector<gpu::BoundBuffer> DeviceScene::geometry() const {
  return {
      {layout::BINDING_NODES, vk::DescriptorType::eStorageBuffer, &nodes_},
      {layout::BINDING_PRIMITIVES, vk::DescriptorType::eStorageBuffer, &primitives_},
      {layout::BINDING_NODE_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &nodes_, &node_texels_},
      {layout::BINDING_PRIMITIVE_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &primitives_, &primitive_texels_}};
}

std::vector<gpu::BoundBuffer> DeviceScene::shading() const {
  return {{layout::BINDING_SHADING, vk::DescriptorType::eStorageBuffer, &shading_},
          {layout::BINDING_SHADING_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &shading_, &shading_texels_}};
}

}  // namespace promin
