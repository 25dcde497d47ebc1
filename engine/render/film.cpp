// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render/film.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <thread>

#include "gpu/device.h"
#include "render.spv.h"

namespace promin {
namespace {

using Access = vk::AccessFlagBits;
using Stage = vk::PipelineStageFlagBits;

constexpr uint32_t kLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;
/// One for each lane of a block.
using Counters = std::array<uvec4, kLanes>;

/// Head of the film buffer (shaders/render.comp).
struct FilmHead {
  layout::Dispatch dispatch{};
  Counters ray_counts{};
};

Counters lanes_of(std::span<const std::byte> counters) {
  Counters lanes;
  assert(counters.size() >= sizeof lanes);
  std::memcpy(lanes.data(), counters.data(), sizeof lanes);
  return lanes;
}

uint64_t bytes_for(uint64_t pixel_count, uint32_t records_per_pixel) {
  return sizeof(FilmHead) + pixel_count * records_per_pixel * sizeof(uvec4);
}

}  // namespace

const vk::DeviceSize Film::kPixelsOffset = sizeof(FilmHead);
const vk::DeviceSize Film::kCountersBytes = sizeof(Counters);

std::span<const uint32_t> render_spirv() {
  return k_render_spirv;
}

Film::Film(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene, FeatureMask features,
           std::span<const uint32_t> spirv)
    : device_(&device),
      scene_(std::move(scene)),
      features_(features),
      frame_(device, sizeof(layout::Frame), vk::BufferUsageFlagBits::eUniformBuffer) {
  reserve(kLanes);
  kernel_.emplace(make_picture_kernel(device, *scene_, features_, frame_, *buffer_, spirv));
}

void Film::reserve(uint32_t pixel_count) {
  if (capacity_ >= pixel_count) return;
  buffer_.emplace(*device_, bytes_for(pixel_count, records_per_pixel()), vk::BufferUsageFlagBits::eStorageBuffer);
  capacity_ = pixel_count;
  if (kernel_) kernel_->bind({layout::BINDING_FILM, vk::DescriptorType::eStorageBuffer, &*buffer_});
}

PieceOptions Film::piece_options() const {
  // On a GPU one group waits while others work.
  constexpr uint32_t kGroupsACore = 8;
  return {.wanted_groups = device_->is_cpu() ? kGroupsACore * std::max(1U, std::thread::hardware_concurrency()) : 0};
}

PicturePieces Film::cut(const View& view, const PixelWindow& window, const PieceOptions& options) const {
  return {scene_->frame(), scene_->dispatch(), view, window, options};
}

void Film::record_begin(const vk::raii::CommandBuffer& commands, const PicturePieces& picture) const {
  assert(picture.pixel_count() <= capacity_);
  const vk::MemoryBarrier before(Access::eShaderWrite | Access::eTransferWrite, Access::eTransferWrite);
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer, Stage::eTransfer, {}, before, {}, {});
  commands.updateBuffer<layout::Frame>(*frame_.handle(), 0, picture.frame());
  commands.fillBuffer(*buffer_->handle(), offsetof(FilmHead, ray_counts), kCountersBytes, 0);
}

void Film::record(const vk::raii::CommandBuffer& commands, const PicturePiece& piece) const {
  kernel_->record(commands, piece.dispatch, *buffer_, piece.group_count);
}

void Film::record_take_counts(const vk::raii::CommandBuffer& commands, const gpu::Buffer& target) const {
  const vk::MemoryBarrier written(Access::eShaderWrite, Access::eTransferRead);
  commands.pipelineBarrier(Stage::eComputeShader, Stage::eTransfer, {}, written, {}, {});
  const vk::DeviceSize offset = offsetof(FilmHead, ray_counts);
  commands.copyBuffer(*buffer_->handle(), *target.handle(), vk::BufferCopy(offset, 0, kCountersBytes));
  const vk::MemoryBarrier copied(Access::eTransferWrite, Access::eHostRead | Access::eTransferWrite);
  commands.pipelineBarrier(Stage::eTransfer, Stage::eTransfer | Stage::eHost, {}, copied, {}, {});
  commands.fillBuffer(*buffer_->handle(), offset, kCountersBytes, 0);
}

void Film::begin(const PicturePieces& picture) const {
  device_->run([&](const vk::raii::CommandBuffer& commands) { record_begin(commands, picture); });
}

double Film::run(const PicturePiece& piece) const {
  return kernel_->run(piece.dispatch, *buffer_, piece.group_count);
}

FilmCounts Film::take_counts() const {
  const gpu::Buffer target = gpu::Buffer::make_readback(*device_, kCountersBytes);
  device_->run([&](const vk::raii::CommandBuffer& commands) { record_take_counts(commands, target); });
  return {sum_counts(target.mapped()), were_loops_cut(target.mapped())};
}

void Film::warm_up() const {
  View one_pixel;
  one_pixel.size = uvec2(1);
  one_pixel.max_depth = 0;
  PicturePieces picture = cut(one_pixel, {uvec2(0), uvec2(1)}, {});
  begin(picture);
  run(picture.next(1.0));
}

uint32_t Film::records_per_pixel() const {
  return (features_ & layout::FEATURE_AOVS) != 0 ? 2 : 1;
}

uint32_t Film::max_capacity() const {
  const uint64_t records = (device_->limits().maxStorageBufferRange - sizeof(FilmHead)) / sizeof(uvec4);
  return static_cast<uint32_t>(records / records_per_pixel());
}

TracingKernel make_picture_kernel(const gpu::Device& device, const DeviceScene& scene, FeatureMask features,
                                  const gpu::Buffer& frame, const gpu::Buffer& film, std::span<const uint32_t> spirv) {
  const std::array constants{
      gpu::SpecializationConstant{layout::CONSTANT_FEATURES, features},
      gpu::SpecializationConstant{layout::CONSTANT_STACK_SIZE, scene.stack_size()},
      gpu::SpecializationConstant{layout::CONSTANT_FETCHES_TEXELS, scene.fetches_texels() ? 1U : 0U}};
  std::vector<gpu::BoundBuffer> buffers = scene.geometry();
  for (const gpu::BoundBuffer& bound : scene.shading()) buffers.push_back(bound);
  buffers.push_back({layout::BINDING_FRAME, vk::DescriptorType::eUniformBuffer, &frame});
  buffers.push_back({layout::BINDING_FILM, vk::DescriptorType::eStorageBuffer, &film});
  return {device, spirv, constants, buffers};
}

void average_samples(std::span<const uvec4> records, uint32_t samples, std::span<vec3> pixels) {
  for (size_t i = 0; i < pixels.size(); ++i) {
    const auto sum = std::bit_cast<std::array<float, 4>>(records[i]);
    pixels[i] = vec3(sum[0], sum[1], sum[2]) / static_cast<float>(samples);
  }
}

RayCounts sum_counts(std::span<const std::byte> counters) {
  RayCounts sum;
  for (const uvec4& lane : lanes_of(counters)) sum += {lane.x, lane.y, lane.z};
  return sum;
}

bool were_loops_cut(std::span<const std::byte> counters) {
  const Counters lanes = lanes_of(counters);
  return std::any_of(lanes.begin(), lanes.end(), [](const uvec4& lane) { return lane.w != 0; });
}

}  // namespace promin
