// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/kernels/tracing_kernel.h"

#include <algorithm>

#include "core/stopwatch.h"
#include "device/buffer.h"
#include "device/device.h"
#include "device_scene/device_scene.h"

namespace promin {
namespace {

using Access = vk::AccessFlagBits;
using Stage = vk::PipelineStageFlagBits;

}  // namespace

void Pacer::aim(double target_ms) {
  units_ = std::max(1.0, units_ * target_ms / target_ms_);
  target_ms_ = target_ms;
}

void Pacer::learn(double units, double time_ms) {
  // The units grow at most by a factor of four in a step, because the next tile may need more time than the last.
  const double ideal = units * target_ms_ / std::max(time_ms, 1e-3);
  units_ = std::clamp(ideal, 1.0, 4.0 * std::max(units_, units));
}

gpu::TraversalForm traversal_form(const gpu::DeviceProfile& profile, const DeviceScene& scene, uint32_t packet_size) {
  gpu::TraversalForm form = packet_size > 1 ? profile.packet_traversal : profile.ray_traversal;
  form.waits_with_solids = form.waits_with_solids && !scene.is_mostly_solids();
  return form;
}

std::vector<gpu::SpecializationConstant> traversal_constants(const gpu::TraversalForm& form, FeatureMask features,
                                                             uint32_t stack_size, bool fetches_texels) {
  return {{layout::CONSTANT_FEATURES, features.words()[0]},
          {layout::CONSTANT_MORE_FEATURES, features.words()[1]},
          {layout::CONSTANT_STACK_SIZE, stack_size},
          {layout::CONSTANT_FETCHES_TEXELS, fetches_texels ? 1U : 0U},
          {layout::CONSTANT_STEPS_TOGETHER, form.steps_together},
          {layout::CONSTANT_WAITS_WITH_SOLIDS, form.waits_with_solids ? 1U : 0U},
          {layout::CONSTANT_WAITS_WITH_HOLES, form.waits_with_holes ? 1U : 0U}};
}

TracingKernel::TracingKernel(const gpu::Device& device, std::span<const uint32_t> spirv,
                             std::span<const gpu::SpecializationConstant> constants,
                             std::span<const gpu::BoundBuffer> buffers)
    : device_(&device), pipeline_(device, spirv, constants, buffers) {
  if (device.timestamp_period_ns() > 0.0) {
    queries_ = vk::raii::QueryPool(device.handle(), vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, 2));
  }
}

void TracingKernel::bind(const gpu::BoundBuffer& buffer) {
  pipeline_.bind(buffer);
}

void TracingKernel::put_constants(const vk::raii::CommandBuffer& commands, const layout::Dispatch& constants,
                                  const gpu::Buffer& head) {
  const vk::MemoryBarrier after_last(Access::eShaderRead | Access::eShaderWrite, Access::eTransferWrite);
  commands.pipelineBarrier(Stage::eComputeShader, Stage::eTransfer, {}, after_last, {}, {});
  commands.updateBuffer<layout::Dispatch>(*head.handle(), 0, constants);
  const vk::MemoryBarrier before(Access::eShaderWrite | Access::eTransferWrite,
                                 Access::eShaderRead | Access::eShaderWrite | Access::eUniformRead);
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer, Stage::eComputeShader, {}, before, {}, {});
}

void TracingKernel::record(const vk::raii::CommandBuffer& commands, const layout::Dispatch& constants,
                           const gpu::Buffer& head, const uvec2& group_count) const {
  put_constants(commands, constants, head);
  pipeline_.dispatch(commands, group_count);
}

double TracingKernel::run(const layout::Dispatch& constants, const gpu::Buffer& head, const uvec2& group_count) const {
  return run([&](const vk::raii::CommandBuffer& commands) { record(commands, constants, head, group_count); });
}

double TracingKernel::run(const std::function<void(const vk::raii::CommandBuffer&)>& record_all) const {
  const Stopwatch waiting;
  device_->run([&](const vk::raii::CommandBuffer& commands) {
    if (*queries_) {
      commands.resetQueryPool(*queries_, 0, 2);
      commands.writeTimestamp(Stage::eTopOfPipe, *queries_, 0);
    }
    record_all(commands);
    if (*queries_) commands.writeTimestamp(Stage::eBottomOfPipe, *queries_, 1);
    const vk::MemoryBarrier after(Access::eShaderWrite, Access::eHostRead);
    commands.pipelineBarrier(Stage::eComputeShader, Stage::eHost, {}, after, {}, {});
  });
  if (!*queries_) return waiting.ms();
  const auto [result, ticks] = queries_.getResults<uint64_t>(
      0, 2, 2 * sizeof(uint64_t), sizeof(uint64_t), vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
  return static_cast<double>(device_->ticks_between(ticks[0], ticks[1])) * device_->timestamp_period_ns() * 1e-6;
}

}  // namespace promin
