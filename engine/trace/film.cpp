// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstring>

#include "camera_stage.spv.h"
#include "device/device.h"
#include "mirror_stage.spv.h"

namespace promin {
namespace {

using Access = vk::AccessFlagBits;
using Stage = vk::PipelineStageFlagBits;

constexpr uint32_t kLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;
/// One for each lane of a block.
using Counters = std::array<uvec4, kLanes>;

/// Head of the film buffer (shaders/film.glsl).
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

/// Paths of the longest queue that a piece may need.
constexpr uint32_t kMostQueuedPaths = TileScheduler::kMaxBlocks * kLanes;

/// Steps and logs are of single rays.
uint32_t pick_packet_size(const gpu::Device& device, FeatureMask features) {
  return features.has_any(layout::FEATURE_STEP_COUNTS) ? 1 : device.profile().pixel_packet_size;
}

}  // namespace

const vk::DeviceSize Film::kPixelsOffset = sizeof(FilmHead);
const vk::DeviceSize Film::kCountersBytes = sizeof(Counters);

PictureShaders picture_shaders() {
  return {k_camera_stage_spirv, k_mirror_stage_spirv};
}

Film::Film(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene, FeatureMask features,
           const FilmOptions& options)
    : device_(&device),
      scene_(std::move(scene)),
      features_(features),
      packet_size_(options.packet_size.value_or(pick_packet_size(device, features))),
      avoids_texels_(options.avoids_texels),
      shaders_(options.shaders),
      view_constants_(device, sizeof(layout::ViewConstants), vk::BufferUsageFlagBits::eUniformBuffer) {
  reserve(kLanes);
  bind_scene();
}

void Film::bind_scene() {
  // The device has compiled it already unless the scene has outgrown its texel buffers.
  kernel_.emplace(make_picture_kernel(*device_, *scene_, features_, packet_size_, view_constants_, *buffer_, shaders_,
                                      avoids_texels_));
}

void Film::reserve(uint32_t pixel_count) {
  if (capacity_ >= pixel_count) return;
  const uint64_t records = uint64_t{pixel_count} * records_per_pixel() + queue_records(pixel_count);
  // There before the old one goes: where memory is short the film stays whole.
  gpu::Buffer buffer(*device_, sizeof(FilmHead) + records * sizeof(uvec4), vk::BufferUsageFlagBits::eStorageBuffer);
  buffer_.emplace(std::move(buffer));
  capacity_ = pixel_count;
  if (kernel_) kernel_->bind({layout::BINDING_FILM, vk::DescriptorType::eStorageBuffer, &*buffer_});
}

TileOptions Film::piece_options() const {
  const gpu::DeviceProfile& profile = device_->profile();
  return {.packet_size = packet_size_,
          .most_group_rows = profile.most_group_rows,
          .wanted_groups = profile.wanted_groups,
          .most_paths_a_lane = profile.most_paths_a_lane};
}

TileScheduler Film::cut(const View& view, const PixelWindow& window, const TileOptions& options) const {
  TileOptions placed = options;
  placed.first_queue_record = capacity_ * records_per_pixel();
  return {scene_->constants(), view, window, placed};
}

void Film::record_begin(const vk::raii::CommandBuffer& commands, const TileScheduler& picture) const {
  assert(picture.pixel_count() <= capacity_);
  const vk::MemoryBarrier before(Access::eShaderWrite | Access::eTransferWrite, Access::eTransferWrite);
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer, Stage::eTransfer, {}, before, {}, {});
  commands.updateBuffer<layout::ViewConstants>(*view_constants_.handle(), 0, picture.view_constants());
  commands.fillBuffer(*buffer_->handle(), offsetof(FilmHead, ray_counts), kCountersBytes, 0);
}

void Film::record(const vk::raii::CommandBuffer& commands, const TileSample& piece) const {
  kernel_->record(commands, piece.dispatch, *buffer_, piece.group_counts);
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

void Film::begin(const TileScheduler& picture) const {
  device_->run([&](const vk::raii::CommandBuffer& commands) { record_begin(commands, picture); });
}

double Film::run(std::span<const TileSample> pieces) const {
  return kernel_->run([&](const vk::raii::CommandBuffer& commands) {
    for (const TileSample& piece : pieces) record(commands, piece);
  });
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
  TileScheduler picture = cut(one_pixel, {uvec2(0), uvec2(1)}, piece_options());
  begin(picture);
  const TileSample piece = picture.next(1.0);
  run({&piece, 1});
}

uint32_t Film::records_per_pixel() const {
  return features_.has_any(layout::FEATURE_AOVS) ? 2 : 1;
}

uint32_t Film::queue_records(uint32_t pixel_count) const {
  if (!features_.has_any(layout::FEATURE_MIRRORS)) return 0;
  return kQueuedPathRecords * std::min(pixel_count, kMostQueuedPaths);
}

uint32_t Film::max_capacity() const {
  const uint64_t records = (device_->limits().maxStorageBufferRange - sizeof(FilmHead)) / sizeof(uvec4);
  return static_cast<uint32_t>((records - queue_records(kMostQueuedPaths)) / records_per_pixel());
}

TracingKernel make_picture_kernel(const gpu::Device& device, const DeviceScene& scene, FeatureMask features,
                                  uint32_t packet_size, const gpu::Buffer& view, const gpu::Buffer& film,
                                  const PictureShaders& shaders, bool avoids_texels) {
  const std::vector<gpu::SpecializationConstant> constants = traversal_constants(
      device.profile().traversal, features, scene.stack_size(), scene.fetches_texels() && !avoids_texels);
  std::vector<gpu::SpecializationConstant> camera_constants = constants;
  camera_constants.push_back({layout::CONSTANT_PACKET_SIZE, packet_size});
  std::vector<gpu::BoundBuffer> buffers = scene.geometry();
  for (const gpu::BoundBuffer& bound : scene.shading()) buffers.push_back(bound);
  buffers.push_back({layout::BINDING_VIEW, vk::DescriptorType::eUniformBuffer, &view});
  buffers.push_back({layout::BINDING_FILM, vk::DescriptorType::eStorageBuffer, &film});
  TracingKernel kernel(device, shaders.camera_stage, camera_constants, buffers);
  if (features.has_any(layout::FEATURE_MIRRORS)) {
    // Mirror rays go everywhere: each is traced alone.
    kernel.add_stage(shaders.mirror_stage, constants, buffers);
  }
  return kernel;
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
