// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "device/pipeline.h"
#include "device/profile.h"
#include "layout.h"
#include "scene/features.h"

namespace promin {

class DeviceScene;

/// Chooses how much work the next dispatch takes so that it lasts about the target, because drivers kill dispatches of
/// seconds.
class Pacer {
 public:
  Pacer(double target_ms, double first_units) : target_ms_(target_ms), units_(first_units) {}

  double units() const { return units_; }
  /// Sets another target; what was learnt stays.
  void aim(double target_ms);
  /// Learns that the last dispatch covered `units` in `time_ms`.
  void learn(double units, double time_ms);

 private:
  double target_ms_;
  double units_;
};

/// Of the profile's forms the one for packets of so many rays. Where the scene has more solids than triangles its
/// solids do not wait, as most leaves hold nothing else.
gpu::TraversalForm traversal_form(const gpu::DeviceProfile& profile, const DeviceScene& scene, uint32_t packet_size);

/// What every pipeline that traces is specialised to.
std::vector<gpu::SpecializationConstant> traversal_constants(const gpu::TraversalForm& form, FeatureMask features,
                                                             uint32_t stack_size, bool fetches_texels);

/// A pipeline that traces, timed by the device's clock where it has one.
class TracingKernel {
 public:
  TracingKernel(const gpu::Device& device, std::span<const uint32_t> spirv,
                std::span<const gpu::SpecializationConstant> constants, std::span<const gpu::BoundBuffer> buffers);

  void bind(const gpu::BoundBuffer& buffer);

  /// Records that `constants` go to the head of `head` and the workgroups run, after all that compute shaders and
  /// transfers recorded before.
  void record(const vk::raii::CommandBuffer& commands, const layout::Dispatch& constants, const gpu::Buffer& head,
              const uvec2& group_count) const;

  /// Runs what `record` records and waits. Returns device milliseconds (waiting time on the host where the queue has no
  /// timestamps).
  double run(const layout::Dispatch& constants, const gpu::Buffer& head, const uvec2& group_count) const;
  /// Does the same with all that `record_all` records, which calls `record` as often as it likes.
  double run(const std::function<void(const vk::raii::CommandBuffer&)>& record_all) const;

 private:
  static void put_constants(const vk::raii::CommandBuffer& commands, const layout::Dispatch& constants,
                            const gpu::Buffer& head);

  const gpu::Device* device_;
  gpu::ComputePipeline pipeline_;
  vk::raii::QueryPool queries_{nullptr};
};

}  // namespace promin
