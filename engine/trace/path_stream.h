// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "device/pipeline.h"
#include "layout.h"
#include "scene/features.h"
#include "trace/picture_shaders.h"

namespace promin {

/// Where the stream of a film lies (shaders/stream.glsl), and what it takes.
struct StreamShape {
  /// For a scene of so many lights, of at most so many paths, within kMostBytes; with glass for pictures of this depth.
  static StreamShape of(uint32_t light_count, FeatureMask features, uint32_t most_paths, uint32_t depth);

  /// Of a path: its records, what it asks for, its places in the lists.
  uint64_t path_bytes() const;
  /// Of all of them, and the bins.
  uint64_t bytes() const;

  uint32_t first_record = 0;
  /// A multiple of the lanes of a workgroup.
  uint32_t most_paths = 0;
  /// Whose shadow rays a turn takes at most; 0 where nothing casts shadows.
  uint32_t sources = 0;
  uint32_t turns_of_bounce = 1;
  /// How many rays of a path may wait; only with glass.
  uint32_t waiting_rays = 0;
  bool has_glass = false;
  /// Whether shadow rays may begin behind a surface.
  bool scatters_through = false;

  /// Of a path, its sources among them.
  uint32_t records_of_path() const;

  static constexpr uint32_t kLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;
  /// Beside the pixels of a film it is less than what Vulkan guarantees for a storage buffer.
  static constexpr uint64_t kMostBytes = 48U << 20;
};

/// Traces the paths of a piece of a picture that a mirror leads on, turn by turn, each by kernels of one kind of work.
/// It keeps nothing: all state is on the film.
class PathStream {
 public:
  /// Compiles unless the device has compiled the same already. `buffers` are those of the camera stage, and the film
  /// as texels.
  PathStream(const gpu::Device& device, FeatureMask features, std::span<const gpu::SpecializationConstant> constants,
             std::span<const gpu::BoundBuffer> buffers, const PictureShaders& shaders);

  void bind(const gpu::BoundBuffer& buffer);

  /// Records that the stream is emptied, before the camera stage puts paths there.
  void record_begin(const vk::raii::CommandBuffer& commands, const gpu::Buffer& film, const StreamShape& shape) const;
  /// Records all turns that paths of so many steps take: bounces, and surfaces that they go through.
  void record_turns(const vk::raii::CommandBuffer& commands, const gpu::Buffer& film, const StreamShape& shape,
                    uint32_t steps) const;
  /// Records a workgroup of each kernel, after record_begin and a dispatch whose numbers the film's head has. They have
  /// nothing to do, but drivers compile late.
  void record_warm_up(const vk::raii::CommandBuffer& commands) const;

 private:
  uint32_t most_group_rows_;
  gpu::ComputePipeline place_;
  gpu::ComputePipeline list_;
  gpu::ComputePipeline shadow_;
  gpu::ComputePipeline follow_;
};

}  // namespace promin
