// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/kernels/path_stream.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#include "core/divide_up.h"
#include "device/buffer.h"
#include "device/device.h"
#include "list_rays.spv.h"
#include "place_rays.spv.h"
#include "trace/kernels/tile_scheduler.h"
#include "trace/kernels/tracing_kernel.h"

namespace promin {
namespace {

using Access = vk::AccessFlagBits;
using Stage = vk::PipelineStageFlagBits;

/// Size of the bins, which follow the lists (shaders/picture/stream.glsl).
constexpr uint64_t kBinBytes = sizeof(uint32_t) * 2 * layout::STREAM_LISTS * layout::STREAM_BINS;

/// Returns the offset of a record in the stream, which follows the film's pixels.
uint64_t offset_of_record(uint64_t record) {
  return sizeof(layout::FilmHead) + record * sizeof(uvec4);
}

std::vector<gpu::SpecializationConstant> with_query(std::span<const gpu::SpecializationConstant> constants,
                                                    bool asks_for_any) {
  std::vector<gpu::SpecializationConstant> all(constants.begin(), constants.end());
  all.push_back({layout::CONSTANT_ALL_ASK_FOR_ANY, asks_for_any ? 1U : 0U});
  return all;
}

/// Returns whether shadow rays must find the nearest surface. A log needs the surface that blocks a ray, and shadow
/// rays pass through surfaces that blend and through glass one surface after the other.
bool needs_nearest_blocker(FeatureMask features) {
  return features.has_any(layout::FEATURE_RAY_LOG | layout::FEATURE_BLENDING | layout::FEATURE_GLASS);
}

/// Returns whether the kernel that follows the paths traces their shadow rays too (TRACES_SHADOWS in
/// shaders/picture/stream.glsl).
bool traces_shadows_with_paths(FeatureMask features) {
  return features.has_any(layout::FEATURE_SCATTERING) &&
         !features.has_any(layout::FEATURE_BLENDING | layout::FEATURE_GLASS | layout::FEATURE_SHADOW_CATCHERS |
                           layout::FEATURE_RAY_LOG);
}

void wait_for_last(const vk::raii::CommandBuffer& commands) {
  const vk::MemoryBarrier barrier(Access::eShaderRead | Access::eShaderWrite | Access::eTransferWrite,
                                  Access::eShaderRead | Access::eShaderWrite | Access::eIndirectCommandRead);
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer, Stage::eComputeShader | Stage::eDrawIndirect, {},
                           barrier, {}, {});
}

}  // namespace

StreamShape StreamShape::of(uint32_t source_count, FeatureMask features, uint32_t most_paths, uint32_t depth) {
  StreamShape shape;
  shape.has_glass = features.has_any(layout::FEATURE_GLASS);
  shape.scatters_through = features.has_any(layout::FEATURE_DIFFUSE_TRANSMISSION);
  shape.samples_lights = features.has_any(layout::FEATURE_SAMPLED_LIGHT);
  shape.traces_with_paths = traces_shadows_with_paths(features);
  shape.has_cones = features.has_any(layout::FEATURE_TEXTURES);
  // At each bounce the mirror ray is followed first, so only refracted rays wait.
  shape.waiting_rays = std::min(refracted_rays(features) * depth, layout::MOST_TREE_RAYS);
  const bool asks_for_shadows = features.has_any(layout::FEATURE_SHADOWS) && !shape.traces_with_paths;
  shape.sources = asks_for_shadows ? std::min(source_count, layout::STREAM_SOURCES) : 0;
  shape.turns_of_bounce = shape.sources == 0 ? 1 : divide_up(source_count, shape.sources);
  const auto fitting = static_cast<uint32_t>(kMostBytes / shape.path_bytes());
  shape.most_paths = std::min(most_paths, fitting) / kLanes * kLanes;
  return shape;
}

uint32_t StreamShape::records_of_path() const {
  if (traces_with_paths) return layout::STREAM_SCATTERED_RECORDS + (has_cones ? 1 : 0);
  const uint32_t of_glass =
      has_glass ? layout::STREAM_GLASS_RECORDS + layout::STREAM_WAITING_RECORDS * waiting_rays : 0;
  const uint32_t of_behind = scatters_through ? layout::STREAM_BEHIND_RECORDS : 0;
  const uint32_t of_sample = samples_lights ? layout::STREAM_SAMPLE_RECORDS : 0;
  return layout::STREAM_PATH_RECORDS + of_behind + of_sample + (layout::STREAM_SOURCE_RECORDS + of_sample) * sources +
         of_glass;
}

uint64_t StreamShape::path_bytes() const {
  const uint64_t records = records_of_path();
  // The words of a path's requests, and its places in the lists.
  const uint64_t words = (1 + sources) + (2 + sources);
  return sizeof(uvec4) * records + sizeof(uint32_t) * words;
}

uint64_t StreamShape::bytes() const {
  return most_paths == 0 ? 0 : path_bytes() * most_paths + kBinBytes;
}

PathStream::PathStream(const gpu::Device& device, FeatureMask features,
                       std::span<const gpu::SpecializationConstant> constants,
                       std::span<const gpu::BoundBuffer> buffers, const PictureShaders& shaders)
    : most_group_rows_(device.profile().most_group_rows),
      traces_with_paths_(traces_shadows_with_paths(features)),
      follow_paths_(shaders.follow_paths),
      follow_constants_(with_query(constants, false)),
      place_(device, k_place_rays_spirv, constants, buffers),
      list_(device, k_list_rays_spirv, constants, buffers),
      follow_(device, follow_paths_, follow_constants_, buffers) {
  if (traces_with_paths_) return;
  shadow_.emplace(device, shaders.trace_shadow_rays, with_query(constants, !needs_nearest_blocker(features)), buffers);
}

void PathStream::bind(const gpu::BoundBuffer& buffer) {
  for (gpu::ComputePipeline* pipeline : {&place_, &list_, &follow_}) pipeline->bind(buffer);
  if (shadow_) shadow_->bind(buffer);
}

void PathStream::record_begin(const vk::raii::CommandBuffer& commands, const gpu::Buffer& film,
                              const StreamShape& shape) const {
  layout::StreamState state{};
  state.place = uvec4(shape.first_record, shape.most_paths, shape.sources, most_group_rows_);
  state.shadow_rays.y = shape.records_of_path();
  // The next increment makes this turn 0.
  state.turn.x = ~0U;
  const vk::MemoryBarrier after_last(Access::eShaderRead | Access::eShaderWrite | Access::eIndirectCommandRead,
                                     Access::eTransferWrite);
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eDrawIndirect, Stage::eTransfer, {}, after_last, {}, {});
  commands.updateBuffer<layout::StreamState>(*film.handle(), offsetof(layout::FilmHead, stream), state);
  const uint64_t first_bin = offset_of_record(shape.first_record) + shape.path_bytes() * shape.most_paths;
  commands.fillBuffer(*film.handle(), first_bin, kBinBytes, 0);
}

void PathStream::record_turns(const vk::raii::CommandBuffer& commands, const gpu::Buffer& film,
                              const StreamShape& shape, uint32_t steps) const {
  const auto dispatch = [&](const gpu::ComputePipeline& pipeline, size_t groups) {
    wait_for_last(commands);
    pipeline.dispatch_indirect(commands, film, offsetof(layout::FilmHead, stream) + groups);
  };
  // The last turn adds the light of the shadow rays of the last step.
  const uint64_t turns = uint64_t{steps} * shape.turns_of_bounce + (traces_with_paths_ ? 0 : 1);
  for (uint64_t turn = 0; turn < turns; ++turn) {
    wait_for_last(commands);
    place_.dispatch(commands, uvec2(1));
    dispatch(list_, offsetof(layout::StreamState, list_groups));
    if (shadow_) dispatch(*shadow_, offsetof(layout::StreamState, shadow_groups));
    dispatch(follow_, offsetof(layout::StreamState, path_groups));
  }
}

void PathStream::record_small_warm_up(const vk::raii::CommandBuffer& commands) const {
  for (const gpu::ComputePipeline* pipeline : {&place_, &list_, shadow_ ? &*shadow_ : nullptr}) {
    if (pipeline == nullptr) continue;
    wait_for_last(commands);
    pipeline->dispatch(commands, uvec2(1));
  }
}

void PathStream::record_large_warm_up(const vk::raii::CommandBuffer& commands) const {
  wait_for_last(commands);
  follow_.dispatch(commands, uvec2(1));
}

}  // namespace promin
