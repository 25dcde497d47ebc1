// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "device/pipeline.h"
#include "device/side_compiler.h"
#include "scene/features.h"
#include "shared/layout.h"
#include "trace/kernels/picture_shaders.h"

namespace promin {

/// The layout and size of the stream of a film (shaders/picture/stream.glsl).
struct StreamShape {
  /// Returns the stream for a scene with this number of lights and at most this number of paths, within kMostBytes.
  /// With glass it is for pictures of this depth.
  static StreamShape of(uint32_t source_count, FeatureMask features, uint32_t most_paths, uint32_t depth);

  /// Returns the number of bytes of a path: its records, its shadow rays, and its entries in the lists.
  uint64_t path_bytes() const;
  /// Returns the number of bytes of all paths and the bins.
  uint64_t bytes() const;

  uint32_t first_record = 0;
  /// Largest number of paths, a multiple of the number of lanes of a workgroup.
  uint32_t most_paths = 0;
  /// Largest number of lights whose shadow rays are traced in a turn; 0 if no object casts shadows, or if the kernel
  /// that follows the paths traces them.
  uint32_t sources = 0;
  uint32_t turns_of_bounce = 1;
  /// Largest number of waiting rays of a path; only with glass.
  uint32_t waiting_rays = 0;
  bool has_glass = false;
  /// True if shadow rays may begin behind a surface.
  bool scatters_through = false;
  /// True if paths and sources keep the data of sampled points of lights (FEATURE_SAMPLED_LIGHT).
  bool samples_lights = false;
  /// True if the kernel that follows scattered paths traces their shadow rays too. Their records are others.
  bool traces_with_paths = false;
  /// True if textures are looked up in the cones of paths.
  bool has_cones = false;

  /// Returns the number of records of a path, including its light sources.
  uint32_t records_of_path() const;

  static constexpr uint32_t kLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;
  /// Largest size of the stream in bytes. With the pixels of a film it is less than the size that Vulkan guarantees for
  /// a storage buffer.
  static constexpr uint64_t kMostBytes = 48U << 20;
};

/// Traces the paths of a piece of a picture after the first mirror or glass surface, turn by turn, with a kernel for
/// each kind of work. It has no state of its own: all state is on the film.
class PathStream {
 public:
  /// Compiles the kernels unless the device has already compiled the same ones. `buffers` are the buffers of the camera
  /// stage, and the film as texels.
  PathStream(const gpu::Device& device, FeatureMask features, std::span<const gpu::SpecializationConstant> constants,
             std::span<const gpu::BoundBuffer> buffers, const PictureShaders& shaders);

  void bind(const gpu::BoundBuffer& buffer);

  /// Records commands that empty the stream, before the camera stage adds paths.
  void record_begin(const vk::raii::CommandBuffer& commands, const gpu::Buffer& film, const StreamShape& shape) const;
  /// Records all turns for paths with this number of steps. A step is a bounce or a surface that the path passes
  /// through.
  void record_turns(const vk::raii::CommandBuffer& commands, const gpu::Buffer& film, const StreamShape& shape,
                    uint32_t steps) const;
  /// Records a workgroup of each kernel except the largest, and of the largest kernel, after record_begin() and a
  /// dispatch whose constants are in the film's head. The workgroups have no work, but drivers compile the kernels now.
  void record_small_warm_up(const vk::raii::CommandBuffer& commands) const;
  void record_large_warm_up(const vk::raii::CommandBuffer& commands) const;
  /// Returns the source of the largest kernel, for the buffers that are bound.
  gpu::KernelSource largest_kernel(std::vector<gpu::BoundBuffer> buffers) const {
    return {follow_paths_, follow_constants_, std::move(buffers)};
  }

 private:
  uint32_t most_group_rows_;
  bool traces_with_paths_;
  std::span<const uint32_t> follow_paths_;
  std::vector<gpu::SpecializationConstant> follow_constants_;
  gpu::ComputePipeline place_;
  gpu::ComputePipeline list_;
  std::optional<gpu::ComputePipeline> shadow_;
  gpu::ComputePipeline follow_;
};

}  // namespace promin
