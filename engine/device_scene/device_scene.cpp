// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/device_scene.h"

#include <algorithm>

#include "device/device.h"

namespace promin {
namespace {

constexpr vk::BufferUsageFlags kStorage = vk::BufferUsageFlagBits::eStorageBuffer;
constexpr vk::BufferUsageFlags kStorageOrTexels = kStorage | vk::BufferUsageFlagBits::eUniformTexelBuffer;

gpu::Buffer upload(const gpu::Device& device, std::span<const std::byte> bytes) {
  gpu::Buffer buffer(device, bytes.size(), kStorageOrTexels);
  buffer.write(bytes);
  return buffer;
}

/// Records of one kind in the buffer of shading.
struct Placed {
  std::span<const std::byte> bytes;
  uint64_t offset = 0;
  /// The index of its first record, in its own stride.
  uint32_t first_index = 0;
  uint64_t end() const { return offset + bytes.size(); }
};

/// Places records at the next multiple of their stride from `offset` on.
template <typename Records>
Placed place(const Records& records, uint64_t offset) {
  constexpr uint64_t kStride = sizeof(typename Records::value_type);
  const uint64_t first = (offset + kStride - 1) / kStride;
  return {std::as_bytes(std::span(records)), first * kStride, static_cast<uint32_t>(first)};
}

void write(gpu::Buffer& buffer, const Placed& placed) {
  if (!placed.bytes.empty()) buffer.write(placed.bytes, placed.offset);
}

}  // namespace

DeviceScene::DeviceScene(const gpu::Device& device, const PackedScene& packed, const ShadingParts& shading)
    : device_(&device),
      nodes_(upload(device, std::as_bytes(packed.tree().nodes))),
      primitives_(upload(device, std::as_bytes(std::span(packed.primitives)))),
      node_texels_(nodes_.make_texel_view()),
      primitive_texels_(primitives_.make_texel_view()),
      // The size grows in steps, so that scenes of about the same depth share pipelines.
      stack_size_((packed.stack_size + 7) / 8 * 8) {
  const Placed surfaces = place(packed.surfaces.surfaces, 0);
  const Placed normals = place(packed.surfaces.normals, surfaces.end());
  const Placed colors = place(packed.surfaces.colors, normals.end());
  constants_.first_index.z = normals.first_index;
  constants_.first_index.w = colors.first_index;
  head_bytes_ = colors.end();
  constants_.tree_bounds = packed.tree_bounds;
  constants_.first_unbounded = packed.first_unbounded();
  constants_.unbounded_count = packed.unbounded_count;
  constants_.environment = shading.environment;
  std::vector<layout::MaterialRecord> materials = pack_materials(shading.materials);
  PackedLights lights = pack_lights(shading.lights);
  take_shading_buffer(make_shading_buffer(place(lights.records, place(materials, head_bytes_).end()).end()));
  for (const Placed& placed : {surfaces, normals, colors}) write(*shading_, placed);
  write_tail(std::move(materials), std::move(lights));
  uploads_.geometry = nodes_.size_bytes() + primitives_.size_bytes() + head_bytes_;
}

void DeviceScene::set_materials(std::span<const Material> materials) {
  write_tail(pack_materials(materials), lights_);
}

void DeviceScene::set_lights(std::span<const Light> lights) {
  write_tail(materials_, pack_lights(lights));
}

void DeviceScene::set_environment(const Environment& environment) {
  constants_.environment = environment;
}

uint64_t DeviceScene::size_bytes() const {
  const uint64_t tail = std::as_bytes(std::span(materials_)).size() + std::as_bytes(std::span(lights_.records)).size();
  return nodes_.size_bytes() + primitives_.size_bytes() + head_bytes_ + tail;
}

std::vector<gpu::BoundBuffer> DeviceScene::geometry() const {
  return {
      {layout::BINDING_NODES, vk::DescriptorType::eStorageBuffer, &nodes_},
      {layout::BINDING_PRIMITIVES, vk::DescriptorType::eStorageBuffer, &primitives_},
      {layout::BINDING_NODE_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &nodes_, &node_texels_},
      {layout::BINDING_PRIMITIVE_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &primitives_, &primitive_texels_}};
}

std::vector<gpu::BoundBuffer> DeviceScene::shading() const {
  return {{layout::BINDING_SHADING, vk::DescriptorType::eStorageBuffer, &*shading_},
          {layout::BINDING_SHADING_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &*shading_, &shading_texels_}};
}

gpu::Buffer DeviceScene::make_shading_buffer(uint64_t tail_end) const {
  // The buffer has room for some more lights, so that switching them on needs no other buffer.
  constexpr uint64_t kSpareBytes = 16 * sizeof(layout::LightRecord);
  return {*device_, tail_end + kSpareBytes, kStorageOrTexels};
}

void DeviceScene::take_shading_buffer(gpu::Buffer buffer) {
  vk::raii::BufferView texels = buffer.make_texel_view();
  shading_texels_ = std::move(texels);
  shading_.emplace(std::move(buffer));
  fetches_texels_ = std::max({nodes_.size_bytes(), primitives_.size_bytes(), shading_->size_bytes()}) <=
                    device_->profile().most_texel_bytes;
}

void DeviceScene::write_tail(std::vector<layout::MaterialRecord> materials, PackedLights lights) {
  const Placed placed_materials = place(materials, head_bytes_);
  const Placed placed_lights = place(lights.records, placed_materials.end());
  if (shading_->size_bytes() < placed_lights.end()) {
    gpu::Buffer larger = make_shading_buffer(placed_lights.end());
    larger.copy_from(*shading_, head_bytes_);
    take_shading_buffer(std::move(larger));
  }
  write(*shading_, placed_materials);
  write(*shading_, placed_lights);
  uploads_.shading += placed_materials.bytes.size() + placed_lights.bytes.size();
  constants_.first_index.x = placed_materials.first_index;
  constants_.first_index.y = placed_lights.first_index;
  constants_.light_count = static_cast<uint32_t>(lights.records.size());
  materials_ = std::move(materials);
  lights_ = std::move(lights);
}

std::shared_ptr<DeviceScene> upload_scene(const gpu::Device& device, const PackedScene& packed,
                                          const ShadingParts& shading) {
  std::shared_ptr<DeviceScene> scene;
  gpu::translate_vulkan_errors([&] { scene = std::make_shared<DeviceScene>(device, packed, shading); });
  return scene;
}

}  // namespace promin
