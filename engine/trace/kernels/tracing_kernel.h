// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "device/pipeline.h"
#include "device/profile.h"
#include "scene/features.h"
#include "shared/layout.h"

namespace promin {

class DeviceScene;

/// Chooses the amount of work of the next dispatch so that the dispatch takes about the target time, because drivers
/// kill dispatches that take seconds.
class Pacer {
 public:
  Pacer(double target_ms, double first_units) : target_ms_(target_ms), units_(first_units) {}

  double units() const { return units_; }
  /// Sets another target. Earlier measurements are kept.
  void aim(double target_ms);
  /// Records that the last dispatch processed `units` in `time_ms`.
  void learn(double units, double time_ms);

 private:
  double target_ms_;
  double units_;
};

/// Returns the profile's traversal form for packets of this size. In a scene with more solids than triangles, solids do
/// not wait, because most leaves contain only solids.
gpu::TraversalForm traversal_form(const gpu::DeviceProfile& profile, const DeviceScene& scene, uint32_t packet_size);

/// Returns the specialisation constants of every pipeline that traces.
std::vector<gpu::SpecializationConstant> traversal_constants(const gpu::TraversalForm& form, FeatureMask features,
                                                             uint32_t stack_size, bool fetches_texels);

/// A pipeline that traces, timed by the device's clock if it has one.
class TracingKernel {
 public:
  TracingKernel(const gpu::Device& device, std::span<const uint32_t> spirv,
                std::span<const gpu::SpecializationConstant> constants, std::span<const gpu::BoundBuffer> buffers);

  void bind(const gpu::BoundBuffer& buffer);

  /// Records commands that write `constants` to the head of `head` and run the workgroups, after all earlier work of
  /// compute shaders and transfers.
  void record(const vk::raii::CommandBuffer& commands, const layout::Dispatch& constants, const gpu::Buffer& head,
              const uvec2& group_count) const;

  /// Runs the commands of `record` and waits. Returns device milliseconds (the host's waiting time if the queue has no
  /// timestamps).
  double run(const layout::Dispatch& constants, const gpu::Buffer& head, const uvec2& group_count) const;
  /// Runs all commands of `record_all`, which may call `record` any number of times, and waits. Returns device
  /// milliseconds.
  double run(const std::function<void(const vk::raii::CommandBuffer&)>& record_all) const;

 private:
  static void put_constants(const vk::raii::CommandBuffer& commands, const layout::Dispatch& constants,
                            const gpu::Buffer& head);

  const gpu::Device* device_;
  gpu::ComputePipeline pipeline_;
  vk::raii::QueryPool queries_{nullptr};
};

}  // namespace promin
