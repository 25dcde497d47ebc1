// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/film.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstring>

#include "camera_stage.spv.h"
#include "core/divide_up.h"
#include "core/parallel.h"
#include "device/device.h"
#include "follow_paths.spv.h"
#include "trace_shadow_rays.spv.h"

namespace promin {
namespace {

using Access = vk::AccessFlagBits;
using Stage = vk::PipelineStageFlagBits;

constexpr uint32_t kLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;

/// Number of samples of a list that a thread processes at a time.
constexpr size_t kListChunk = 65536;

/// Counters, one for each lane of a block.
using Counters = std::array<uvec4, kLanes>;

/// Returns the counters of the lanes: first the rays and cut loops, then the continuations behind surfaces
/// (shaders/picture/film.glsl).
std::array<Counters, 2> lanes_of(std::span<const std::byte> counters) {
  std::array<Counters, 2> lanes;
  assert(counters.size() >= sizeof lanes);
  std::memcpy(lanes.data(), counters.data(), sizeof lanes);
  return lanes;
}
static_assert(offsetof(layout::FilmHead, pass_counts) == offsetof(layout::FilmHead, ray_counts) + sizeof(Counters));
static_assert(sizeof(layout::FilmHead::ray_counts) == sizeof(Counters));

uint32_t pick_packet_size(const gpu::DeviceProfile& profile, FeatureMask features, const FilmOptions& options) {
  if (options.packet_size) return *options.packet_size;
  // Packets share their steps, so step counts need single rays.
  const bool takes_packets =
      !features.has_any(layout::FEATURE_STEP_COUNTS) && options.expected_samples >= profile.samples_that_repay_packets;
  return takes_packets ? profile.pixel_packet_size : 1;
}

}  // namespace

const vk::DeviceSize Film::kPixelsOffset = sizeof(layout::FilmHead);
const vk::DeviceSize Film::kCountersBytes = 2 * sizeof(Counters);

PictureShaders picture_shaders() {
  return {k_camera_stage_spirv, k_trace_shadow_rays_spirv, k_follow_paths_spirv};
}

Film::Film(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene, FeatureMask features,
           const FilmOptions& options)
    : device_(&device),
      scene_(std::move(scene)),
      features_(features),
      records_(features),
      packet_size_(pick_packet_size(device.profile(), features, options)),
      avoids_texels_(options.avoids_texels),
      waits_with_holes_(options.waits_with_holes),
      shaders_(options.shaders),
      log_records_(options.log_records),
      view_constants_(device, sizeof(layout::ViewConstants), vk::BufferUsageFlagBits::eUniformBuffer) {
  reserve(kLanes);
  bind_scene();
}

std::array<gpu::BoundBuffer, 2> Film::film_buffers() const {
  return {{{layout::BINDING_FILM, vk::DescriptorType::eStorageBuffer, &*buffer_},
           {layout::BINDING_FILM_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &*buffer_, &texels_}}};
}

std::vector<gpu::BoundBuffer> Film::buffers() const {
  std::vector<gpu::BoundBuffer> buffers = scene_->geometry();
  for (const gpu::BoundBuffer& bound : scene_->shading()) buffers.push_back(bound);
  buffers.push_back({layout::BINDING_VIEW, vk::DescriptorType::eUniformBuffer, &view_constants_});
  for (const gpu::BoundBuffer& bound : film_buffers()) buffers.push_back(bound);
  return buffers;
}

void Film::bind_scene() {
  // After a change of lights the stream may be larger.
  reserve(capacity_);
  // If the device has already compiled the pipeline, it is used again, unless the scene no longer fits in texel
  // buffers.
  const auto constants_for = [&](uint32_t packet_size) {
    gpu::TraversalForm form = traversal_form(device_->profile(), *scene_, packet_size);
    form.waits_with_holes = waits_with_holes_.value_or(form.waits_with_holes);
    std::vector<gpu::SpecializationConstant> constants =
        traversal_constants(form, features_, scene_->stack_size(), scene_->fetches_texels() && !avoids_texels_);
    constants.push_back({layout::CONSTANT_PACKET_SIZE, packet_size});
    constants.push_back({layout::CONSTANT_FETCHES_FILM_TEXELS, fetches_film_texels() ? 1U : 0U});
    return constants;
  };
  const std::vector<gpu::BoundBuffer> bound = buffers();
  stream_.reset();
  // A driver compiles a pipeline in one thread, so the two stages are compiled in parallel.
  for_each_index(has_stream() ? 2 : 1, 0, [&](size_t stage) {
    if (stage == 0) {
      kernel_.emplace(*device_, shaders_.camera_stage, constants_for(packet_size_), bound);
      return;
    }
    stream_.emplace(*device_, features_, constants_for(1), bound, shaders_);
  });
}

void Film::reserve(uint32_t pixel_count) {
  pixel_count = std::max(pixel_count, capacity_);
  const uint64_t records = uint64_t{pixel_count} * records_.count + log_records_;
  const uint64_t bytes_of_line = layout::STREAM_SCATTERED_RECORDS * sizeof(uvec4);
  const uint64_t bytes =
      sizeof(layout::FilmHead) + records * sizeof(uvec4) + bytes_of_line + bytes_of_stream(pixel_count);
  if (buffer_ && buffer_->size_bytes() >= bytes && capacity_ == pixel_count) return;
  using Usage = vk::BufferUsageFlagBits;
  // The new buffer is created before the old one is freed, so that the film stays valid if memory is short.
  gpu::Buffer buffer(*device_, bytes, Usage::eStorageBuffer | Usage::eUniformTexelBuffer | Usage::eIndirectBuffer);
  vk::raii::BufferView texels = buffer.make_texel_view();
  texels_ = std::move(texels);
  buffer_.emplace(std::move(buffer));
  capacity_ = pixel_count;
  if (!kernel_) return;
  for (const gpu::BoundBuffer& bound : film_buffers()) {
    kernel_->bind(bound);
    if (stream_) stream_->bind(bound);
  }
}

void Film::put_list(std::span<const ListedSample> samples) {
  const uvec2 size = list_window(samples.size()).hi;
  reserve(size.x * size.y);
  list_records_.assign(size_t{size.x} * size.y, uvec4(0, 0, layout::NO_LISTED_SAMPLE, 0));
  for_each_chunk(samples.size(), kListChunk, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const ListedSample& sample = samples[i];
      list_records_[i] = uvec4(std::bit_cast<uint32_t>(sample.place.x), std::bit_cast<uint32_t>(sample.place.y),
                               sample.pixel.x | sample.pixel.y << 16, sample.number);
    }
  });
  buffer_->write(std::as_bytes(std::span(list_records_)), kPixelsOffset);
  list_records_.resize(list_records_.size() * records_.count);
}

ReadFilm Film::read_list() {
  const size_t pixel_count = list_records_.size() / records_.count;
  buffer_->read(std::as_writable_bytes(std::span(list_records_)), kPixelsOffset);
  return {list_records_, pixel_count, records_};
}

void Film::put_pixels(std::span<const uvec4> records, const uvec2& size) {
  assert(records.size() <= size_t{capacity_} * records_.count);
  layout::Dispatch traced{};
  traced.window = uvec4(0, 0, size);
  traced.sampling.x = 1;
  buffer_->write(std::as_bytes(std::span(&traced, 1)), offsetof(layout::FilmHead, dispatch));
  buffer_->write(std::as_bytes(records), kPixelsOffset);
}

TileOptions Film::piece_options(uint32_t depth) const {
  const gpu::DeviceProfile& profile = device_->profile();
  // The stream has space for the paths of a piece, even if all of its pixels have paths.
  const uint32_t most_paths = stream_shape(TileOptions::kMaxBlocks * kLanes, depth).most_paths;
  return {.packet_size = packet_size_,
          .most_group_rows = profile.most_group_rows,
          .most_blocks = has_stream() ? most_paths / kLanes : TileOptions::kMaxBlocks,
          .most_layers = most_layers(),
          .refracted_rays = refracted_rays(features_),
          .is_listed = is_listed()};
}

bool Film::is_listed() const {
  return features_.has_any(layout::FEATURE_LISTED_SAMPLES);
}

SampledPoints Film::sampled_points(const View& view) const {
  const RenderMode& mode = view.mode;
  const bool samples_sources = mode.integrator != Integrator::kWhitted && mode.debug_view == DebugView::kNone;
  // A film without the feature ignores the lens of a camera.
  const bool samples_lens = features_.has_any(layout::FEATURE_LENS) && has_lens(view.camera);
  return {.any = samples_sources || samples_lens || mode.debug_view == DebugView::kOcclusion ||
                 scene_->has_light_with_size(),
          .of_many_sources = samples_sources && scene_->are_lights_chosen()};
}

TileScheduler Film::cut(const View& view, const PixelWindow& window, const TileOptions& options) const {
  return {scene_->constants(), view, window, options};
}

void Film::record_begin(const vk::raii::CommandBuffer& commands, const TileScheduler& picture) const {
  assert(picture.pixel_count() <= capacity_);
  const vk::MemoryBarrier before(Access::eShaderWrite | Access::eTransferWrite, Access::eTransferWrite);
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer, Stage::eTransfer, {}, before, {}, {});
  commands.updateBuffer<layout::ViewConstants>(*view_constants_.handle(), 0, picture.view_constants());
  commands.fillBuffer(*buffer_->handle(), offsetof(layout::FilmHead, ray_counts), kCountersBytes, 0);
  if (!picture.begins_sums()) return;
  // Most samples add to few of these sums. The first sample therefore cannot initialise all of them, as it does with
  // other sums, so they are cleared.
  const vk::DeviceSize record_bytes = picture.pixel_count() * sizeof(uvec4);
  const auto clear = [&](uint32_t first, uint32_t count) {
    commands.fillBuffer(*buffer_->handle(), kPixelsOffset + first * record_bytes, count * record_bytes, 0);
  };
  if (picture.begins_without_first()) clear(0, 1);
  if (features_.has_any(layout::FEATURE_LIGHT_AOVS)) clear(records_.first_part, layout::PART_RECORDS);
  if (features_.has_any(layout::FEATURE_UNLIT_SHARE)) clear(records_.unlit, 1);
}

void Film::record(const vk::raii::CommandBuffer& commands, const TileSample& piece) const {
  const StreamShape shape = stream_shape(capacity_, piece.depth);
  const bool takes_stream = stream_ && piece.steps > 0;
  if (takes_stream) stream_->record_begin(commands, *buffer_, shape);
  kernel_->record(commands, piece.dispatch, *buffer_, piece.group_count);
  if (takes_stream) stream_->record_turns(commands, *buffer_, shape, piece.steps);
}

void Film::record_take_counts(const vk::raii::CommandBuffer& commands, const gpu::Buffer& target) const {
  const vk::MemoryBarrier written(Access::eShaderWrite, Access::eTransferRead);
  commands.pipelineBarrier(Stage::eComputeShader, Stage::eTransfer, {}, written, {}, {});
  const vk::DeviceSize offset = offsetof(layout::FilmHead, ray_counts);
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

std::optional<gpu::KernelSource> Film::side_kernel() const {
  if (!stream_) return std::nullopt;
  return stream_->largest_kernel(buffers());
}

void Film::warm_up() {
  if (is_listed()) put_list({});
  View one_pixel;
  one_pixel.size = uvec2(1);
  one_pixel.max_depth = 0;
  TileScheduler picture = cut(one_pixel, {uvec2(0), uvec2(1)}, piece_options(one_pixel.max_depth));
  const TileSample piece = picture.next(1.0);
  std::optional<gpu::SideCompiler> largest;
  if (const auto kernel = side_kernel()) largest.emplace(*device_, *kernel);
  device_->run([&](const vk::raii::CommandBuffer& commands) {
    record_begin(commands, picture);
    record(commands, piece);
    // The stream's kernels read the constants that the piece has written to the film's head. Before that, the head may
    // contain any number, for example a number of turns for the check of loops that would take minutes.
    if (!stream_) return;
    stream_->record_begin(commands, *buffer_, stream_shape(capacity_, 0));
    stream_->record_small_warm_up(commands);
  });
  largest.reset();
  if (stream_) device_->run([&](const auto& commands) { stream_->record_large_warm_up(commands); });
}

uint32_t Film::most_layers() const {
  return features_.has_any(layout::FEATURE_BLENDING) ? layout::MOST_LAYERS : 0;
}

uint64_t Film::bytes_of_stream(uint32_t pixel_count) const {
  uint64_t bytes = stream_shape(pixel_count, 0).bytes();
  // With glass, deep pictures need more memory for a path, so there is space for fewer paths.
  if (!features_.has_any(layout::FEATURE_GLASS)) return bytes;
  for (uint32_t depth = 1; depth <= layout::MOST_TREE_RAYS; ++depth) {
    bytes = std::max(bytes, stream_shape(pixel_count, depth).bytes());
  }
  return bytes;
}

bool Film::has_stream() const {
  return features_.has_any(layout::FEATURE_MIRRORS | layout::FEATURE_BLENDING | layout::FEATURE_SCATTERING);
}

bool Film::fetches_film_texels() const {
  const gpu::DeviceProfile& profile = device_->profile();
  const bool holds_any_film = device_->limits().maxStorageBufferRange <= profile.most_texel_bytes;
  return profile.fetches_film_texels && holds_any_film && !avoids_texels_;
}

StreamShape Film::stream_shape(uint32_t pixel_count, uint32_t depth) const {
  if (!has_stream()) return {};
  const uint32_t most_paths = std::min(device_->profile().most_stream_paths, next_multiple(pixel_count, kLanes));
  const SceneConstants& constants = scene_->constants();
  const uint32_t sources = constants.source_count(features_.has_any(layout::FEATURE_SKY_LIGHT));
  StreamShape shape = StreamShape::of(sources, features_, most_paths, depth);
  // The records of a path begin at a cache line if they fill one.
  constexpr uint32_t kLine = layout::STREAM_SCATTERED_RECORDS;
  const uint32_t before = layout::FILM_HEAD_TEXELS + pixel_count * records_.count + log_records_;
  shape.first_record = next_multiple(before, kLine) - layout::FILM_HEAD_TEXELS;
  return shape;
}

uint32_t Film::max_capacity() const {
  const uint64_t records = (device_->limits().maxStorageBufferRange - sizeof(layout::FilmHead)) / sizeof(uvec4);
  const uint64_t most_of_stream = StreamShape::kMostBytes / sizeof(uvec4);
  return static_cast<uint32_t>((records - most_of_stream) / records_.count);
}

PixelWindow list_window(size_t sample_count) {
  // The number of blocks in a row, at least one.
  const auto blocks = static_cast<uint32_t>(std::max<size_t>(divide_up(sample_count, size_t{kLanes}), 1));
  return {uvec2(0), uvec2(blocks * layout::BLOCK_SIZE, layout::BLOCK_SIZE)};
}

void average_samples(std::span<const uvec4> records, uint32_t samples, std::span<vec3> pixels) {
  for_each_pixel(pixels.size(), [&](size_t i) {
    const auto sum = std::bit_cast<std::array<float, 4>>(records[i]);
    pixels[i] = vec3(sum[0], sum[1], sum[2]) / static_cast<float>(samples);
  });
}

RayCounts sum_counts(std::span<const std::byte> counters) {
  RayCounts sum;
  const auto [rays, passes] = lanes_of(counters);
  for (size_t lane = 0; lane < rays.size(); ++lane) {
    sum += {.primary = rays[lane].x,
            .shadow = rays[lane].y,
            .reflection = rays[lane].z,
            .refraction = passes[lane].y,
            .passed = passes[lane].x,
            .primary_hits = passes[lane].z};
  }
  return sum;
}

bool were_loops_cut(std::span<const std::byte> counters) {
  const Counters lanes = lanes_of(counters)[0];
  return std::any_of(lanes.begin(), lanes.end(), [](const uvec4& lane) { return lane.w != 0; });
}

}  // namespace promin
