// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render/device_scene.h"

namespace promin {
namespace {

gpu::Buffer upload(const gpu::Device& device, std::span<const std::byte> bytes) {
  gpu::Buffer buffer(device, bytes.size(), vk::BufferUsageFlagBits::eStorageBuffer);
  buffer.write(bytes);
  return buffer;
}

}  // namespace

DeviceScene::DeviceScene(const gpu::Device& device, const PackedScene& packed)
    : nodes_(upload(device, std::as_bytes(std::span(packed.nodes)))),
      primitives_(upload(device, std::as_bytes(std::span(packed.primitives)))),
      shading_(upload(device, packed.shading)),
      frame_(packed.frame),
      dispatch_(packed.dispatch),
      // In steps, so that scenes of about the same depth share pipelines.
      stack_size_((packed.stack_size + 7) / 8 * 8) {}

std::vector<gpu::BoundBuffer> DeviceScene::geometry() const {
  return {{layout::BINDING_NODES, vk::DescriptorType::eStorageBuffer, &nodes_},
          {layout::BINDING_PRIMITIVES, vk::DescriptorType::eStorageBuffer, &primitives_}};
}

gpu::BoundBuffer DeviceScene::shading() const {
  return {layout::BINDING_SHADING, vk::DescriptorType::eStorageBuffer, &shading_};
}

}  // namespace promin
