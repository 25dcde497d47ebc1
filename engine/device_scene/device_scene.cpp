// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/device_scene.h"

#include <algorithm>
#include <cstring>

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

/// Appends records at the next multiple of their stride; returns their first index in that stride.
template <typename Records>
uint32_t append_records(std::vector<std::byte>& bytes, uint64_t bytes_before, const Records& records) {
  using Record = typename Records::value_type;
  const size_t first = (bytes_before + bytes.size() + sizeof(Record) - 1) / sizeof(Record);
  const size_t offset = first * sizeof(Record) - bytes_before;
  bytes.resize(offset + records.size() * sizeof(Record));
  if (!records.empty()) std::memcpy(bytes.data() + offset, records.data(), records.size() * sizeof(Record));
  return static_cast<uint32_t>(first);
}

}  // namespace

DeviceScene::DeviceScene(const gpu::Device& device, const PackedScene& packed)
    : device_(&device),
      nodes_(upload(device, std::as_bytes(packed.tree().nodes))),
      primitives_(upload(device, std::as_bytes(std::span(packed.primitives)))),
      node_texels_(nodes_.make_texel_view()),
      primitive_texels_(primitives_.make_texel_view()),
      // In steps, so that scenes of about the same depth share pipelines.
      stack_size_((packed.stack_size + 7) / 8 * 8) {
  append_records(head_, 0, packed.surfaces.surfaces);
  constants_.first_index.z = append_records(head_, 0, packed.surfaces.normals);
  constants_.first_index.w = append_records(head_, 0, packed.surfaces.colors);
  head_bytes_ = head_.size();
  constants_.tree_bounds = packed.tree_bounds;
  constants_.first_unbounded = packed.first_unbounded();
  constants_.unbounded_count = packed.unbounded_count;
  uploads_.geometry = nodes_.size_bytes() + primitives_.size_bytes() + head_bytes_;
  write_tail();
}

void DeviceScene::set_materials(std::span<const Material> materials) {
  materials_ = pack_materials(materials);
  write_tail();
}

void DeviceScene::set_lights(std::span<const Light> lights) {
  PackedLights packed = pack_lights(lights);
  lights_ = std::move(packed.records);
  light_numbers_ = std::move(packed.numbers);
  constants_.light_count = static_cast<uint32_t>(lights_.size());
  write_tail();
}

void DeviceScene::set_environment(const Environment& environment) {
  constants_.environment = environment;
}

uint64_t DeviceScene::size_bytes() const {
  const uint64_t tail = std::as_bytes(std::span(materials_)).size() + std::as_bytes(std::span(lights_)).size();
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

void DeviceScene::write_tail() {
  std::vector<std::byte> tail;
  constants_.first_index.x = append_records(tail, head_bytes_, materials_);
  constants_.first_index.y = append_records(tail, head_bytes_, lights_);
  const uint64_t needed = head_bytes_ + tail.size();
  if (!shading_ || shading_->size_bytes() < needed) {
    // With room for some lights more, so that switching them on needs no other buffer.
    constexpr uint64_t kSpareBytes = 16 * sizeof(layout::LightRecord);
    gpu::Buffer larger(*device_, needed + kSpareBytes, kStorageOrTexels);
    if (shading_) {
      larger.copy_from(*shading_, head_bytes_);
    } else {
      larger.write(head_);
      head_ = {};
    }
    vk::raii::BufferView texels = larger.make_texel_view();
    shading_texels_ = std::move(texels);
    shading_.emplace(std::move(larger));
    fetches_texels_ = std::max({nodes_.size_bytes(), primitives_.size_bytes(), shading_->size_bytes()}) <=
                      device_->limits().maxTexelBufferElements * gpu::kTexelBytes;
  }
  if (!tail.empty()) shading_->write(tail, head_bytes_);
  uploads_.shading += tail.size();
}

std::shared_ptr<const DeviceScene> upload_scene(const gpu::Device& device, const PackedScene& packed) {
  std::shared_ptr<const DeviceScene> scene;
  gpu::translate_vulkan_errors([&] { scene = std::make_shared<const DeviceScene>(device, packed); });
  return scene;
}

std::shared_ptr<DeviceScene> upload_scene(const gpu::Device& device, const PackedScene& packed,
                                          const world::Scene& scene) {
  std::shared_ptr<DeviceScene> uploaded;
  gpu::translate_vulkan_errors([&] {
    uploaded = std::make_shared<DeviceScene>(device, packed);
    uploaded->set_materials(scene.materials);
    uploaded->set_lights(scene.lights);
    uploaded->set_environment(scene.environment);
  });
  return uploaded;
}

}  // namespace promin
