// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/kernels/ray_kernel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <vector>

#include "cast.spv.h"
#include "core/divide_up.h"
#include "core/shared_progress.h"
#include "core/stopwatch.h"
#include "crossings.spv.h"
#include "device/device.h"
#include "device_scene/device_scene.h"
#include "trace/kernels/cut_loops.h"
#include "trace/kernels/group_rows.h"
#include "trace/kernels/tracing_kernel.h"

namespace promin {
namespace {

constexpr uint32_t kGroupLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;
/// Number of rays in the first dispatch, enough to keep the device's cores busy.
constexpr double kFirstRays = 64.0 * kGroupLanes;
static_assert(RayKernel::kMaxRays / kGroupLanes <= 65535, "Vulkan's guaranteed workgroup count");

constexpr auto kRecordsUsage = vk::BufferUsageFlagBits::eStorageBuffer;

vk::DeviceSize hits_size(size_t record_count) {
  return sizeof(layout::Dispatch) + record_count * sizeof(layout::HitRecord);
}

std::span<const uint32_t> spirv_of(const RayKernelOptions& options) {
  if (!options.spirv.empty()) return options.spirv;
  return asks_for_crossings(options.query) ? crossings_spirv() : cast_spirv();
}

}  // namespace

std::span<const uint32_t> cast_spirv() {
  return k_cast_spirv;
}

std::span<const uint32_t> crossings_spirv() {
  return k_crossings_spirv;
}

struct RayKernel::Impl {
  Impl(const gpu::Device& the_device, std::shared_ptr<const DeviceScene> the_scene, const RayKernelOptions& the_options)
      : device(the_device),
        scene(std::move(the_scene)),
        options(the_options),
        pacer(options.target_dispatch_ms.value_or(device.profile().target_dispatch_ms), kFirstRays) {
    const Stopwatch compiling;
    view_constants.emplace(device, sizeof(layout::ViewConstants), vk::BufferUsageFlagBits::eUniformBuffer);
    take_constants();
    make_buffers(1, 1);
    std::vector<gpu::SpecializationConstant> constants =
        traversal_constants(options.traversal.value_or(traversal_form(device.profile(), *scene, options.packet_size)),
                            options.features, scene->stack_size(), fetches_texels());
    constants.push_back({layout::CONSTANT_PACKET_SIZE, options.packet_size});
    constants.push_back({layout::CONSTANT_ALL_ASK_FOR_ANY, options.query == HitQuery::kNearest ? 0U : 1U});
    if (asks_for_crossings(options.query)) {
      constants.push_back({layout::CONSTANT_LISTS_CROSSINGS, options.query == HitQuery::kAll ? 1U : 0U});
    }
    std::vector<gpu::BoundBuffer> buffers = scene->geometry();
    buffers.push_back({layout::BINDING_VIEW, vk::DescriptorType::eUniformBuffer, &*view_constants});
    for (const gpu::BoundBuffer& buffer : ray_buffers()) buffers.push_back(buffer);
    kernel.emplace(device, spirv_of(options), constants, buffers);
    // Drivers compile in the first dispatch of a pipeline, which must not count as tracing.
    const layout::Dispatch no_rays = make_cast_dispatch(scene->constants(), 0, 0);
    kernel->run(no_rays, *hits, uvec2(1));
    pipeline_ms = compiling.ms();
  }

  void take_constants() {
    const layout::ViewConstants values = make_cast_constants(scene->constants());
    view_constants->write(std::as_bytes(std::span(&values, 1)));
  }

  std::array<gpu::BoundBuffer, 3> ray_buffers() const {
    return {{{layout::BINDING_RAYS, vk::DescriptorType::eStorageBuffer, &*rays},
             {layout::BINDING_RAY_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &*rays, &ray_texels},
             {layout::BINDING_HITS, vk::DescriptorType::eStorageBuffer, &*hits}}};
  }

  bool fetches_texels() const {
    return scene->fetches_texels() && !options.avoids_texels &&
           RayKernel::kMaxRays * sizeof(layout::RayRecord) <= device.profile().most_texel_bytes;
  }

  void make_buffers(size_t ray_count, size_t record_count) {
    if (ray_count <= ray_capacity && record_count <= record_capacity) return;
    ray_count = std::max(ray_count, ray_capacity);
    record_count = std::max(record_count, record_capacity);
    // Both new buffers exist before either old one is replaced, so that the pipeline is never bound to a freed buffer.
    gpu::Buffer new_rays(device, ray_count * sizeof(layout::RayRecord),
                         kRecordsUsage | vk::BufferUsageFlagBits::eUniformTexelBuffer);
    vk::raii::BufferView new_ray_texels = new_rays.make_texel_view();
    gpu::Buffer new_hits(device, hits_size(record_count), kRecordsUsage);
    ray_texels = std::move(new_ray_texels);
    rays.emplace(std::move(new_rays));
    hits.emplace(std::move(new_hits));
    ray_capacity = ray_count;
    record_capacity = record_count;
    if (!kernel) return;
    for (const gpu::BoundBuffer& buffer : ray_buffers()) kernel->bind(buffer);
  }

  bool were_loops_cut() const {
    if (!device.profile().may_cut_loops) return false;
    layout::Dispatch head;
    hits->read(std::as_writable_bytes(std::span(&head, 1)));
    return head.outcome.x != 0;
  }

  double run(size_t count, const std::function<void(std::span<layout::RayRecord>)>& fill,
             const std::function<void(std::span<const layout::HitRecord>)>& take, const ProgressCallback& progress) {
    make_buffers(count, count);
    rays->write_by(
        [&](std::span<std::byte> bytes) {
          fill({reinterpret_cast<layout::RayRecord*>(bytes.data()), count});
        },
        count * sizeof(layout::RayRecord));
    const double time_ms = trace(count, progress);
    hits->read_by(
        [&](std::span<const std::byte> bytes) {
          take({reinterpret_cast<const layout::HitRecord*>(bytes.data()), count});
        },
        count * sizeof(layout::HitRecord), sizeof(layout::Dispatch));
    return time_ms;
  }

  double list(std::span<const layout::RayRecord> input, std::span<const uint32_t> counts,
              std::span<layout::HitRecord> crossings, const ProgressCallback& progress) {
    make_buffers(input.size(), input.size() + crossings.size());
    heads.resize(input.size());
    auto place = static_cast<uint32_t>(input.size());
    for (size_t i = 0; i < input.size(); ++i) {
      heads[i] = {uvec4(0, place, counts[i], 0), uvec4(0)};
      place += counts[i];
    }
    const std::span<std::byte> head_bytes = std::as_writable_bytes(std::span(heads));
    hits->write(head_bytes, sizeof(layout::Dispatch));
    rays->write(std::as_bytes(input));
    const double time_ms = trace(input.size(), progress);
    hits->read(head_bytes, sizeof(layout::Dispatch));
    for (size_t i = 0; i < input.size(); ++i) {
      if (heads[i].a.x != counts[i]) {
        throw RunError({"device.lists.differ", "the device lists other crossings of a ray than it has counted", "",
                        "use another device", Setting::kDevice});
      }
    }
    hits->read(std::as_writable_bytes(crossings), hits_size(input.size()));
    return time_ms;
  }

  /// Traces the first `ray_count` rays of the buffer.
  double trace(size_t ray_count, const ProgressCallback& progress) {
    double total_ms = 0.0;
    const uint32_t most_group_rows = device.profile().most_group_rows;
    const auto end = static_cast<uint32_t>(ray_count);
    const uint32_t group_rays = kGroupLanes * options.packet_size;
    for (uint32_t first = 0; first < end;) {
      // A workgroup with fewer rays takes the same time. Without this limit, the pacer would go down to one ray on a
      // busy machine.
      const double paced = std::max<double>(pacer.units(), group_rays);
      const double wanted = options.rays_per_dispatch > 0 ? options.rays_per_dispatch : paced;
      const auto count = static_cast<uint32_t>(std::min<double>(wanted, end - first));
      const layout::Dispatch dispatch = make_cast_dispatch(scene->constants(), first, first + count);
      // Lanes beyond the last ray do nothing.
      const uvec2 groups = arrange_in_rows(divide_up(count, group_rays), most_group_rows);
      const double time_ms = kernel->run(dispatch, *hits, groups);
      refuse_cut_loops(were_loops_cut());
      pacer.learn(count, time_ms);
      total_ms += time_ms;
      first += count;
      if (first < end) tell_progress(progress, static_cast<double>(first) / static_cast<double>(end));
    }
    return total_ms;
  }

  const gpu::Device& device;
  std::shared_ptr<const DeviceScene> scene;
  RayKernelOptions options;
  Pacer pacer;
  std::optional<gpu::Buffer> view_constants;
  std::optional<gpu::Buffer> rays;
  vk::raii::BufferView ray_texels{nullptr};
  std::optional<gpu::Buffer> hits;
  size_t ray_capacity = 0;
  size_t record_capacity = 0;
  /// Each ray's own record, for lists.
  std::vector<layout::HitRecord> heads;
  std::optional<TracingKernel> kernel;
  double pipeline_ms = 0.0;
};

RayKernel::RayKernel(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene,
                     const RayKernelOptions& options) {
  gpu::translate_vulkan_errors([&] { impl_ = std::make_unique<Impl>(device, std::move(scene), options); });
}
RayKernel::~RayKernel() = default;
RayKernel::RayKernel(RayKernel&&) noexcept = default;
RayKernel& RayKernel::operator=(RayKernel&&) noexcept = default;

double RayKernel::run(std::span<const layout::RayRecord> rays, std::span<layout::HitRecord> records,
                      const ProgressCallback& progress) {
  assert(rays.size() == records.size());
  return run(
      rays.size(), [&](std::span<layout::RayRecord> filled) { std::ranges::copy(rays, filled.begin()); },
      [&](std::span<const layout::HitRecord> taken) { std::ranges::copy(taken, records.begin()); }, progress);
}

double RayKernel::run(size_t count, const std::function<void(std::span<layout::RayRecord>)>& fill,
                      const std::function<void(std::span<const layout::HitRecord>)>& take,
                      const ProgressCallback& progress) {
  assert(count <= kMaxRays);
  if (count == 0) return 0.0;
  double time_ms = 0.0;
  gpu::translate_vulkan_errors([&] { time_ms = impl_->run(count, fill, take, progress); });
  return time_ms;
}

double RayKernel::list(std::span<const layout::RayRecord> rays, std::span<const uint32_t> counts,
                       std::span<layout::HitRecord> crossings, const ProgressCallback& progress) {
  assert(rays.size() <= kMaxRays && rays.size() == counts.size() && crossings.size() <= most_listed(rays.size()));
  if (rays.empty()) return 0.0;
  double time_ms = 0.0;
  gpu::translate_vulkan_errors([&] { time_ms = impl_->list(rays, counts, crossings, progress); });
  return time_ms;
}

uint64_t RayKernel::most_listed(size_t ray_count) const {
  const uint64_t bytes = gpu::Buffer::most_bytes(impl_->device, kRecordsUsage);
  const uint64_t most_records = (bytes - sizeof(layout::Dispatch)) / sizeof(layout::HitRecord);
  // Places are 32-bit numbers.
  return std::min<uint64_t>(most_records, UINT32_MAX) - std::min<uint64_t>(ray_count, most_records);
}

void RayKernel::take_constants() {
  impl_->take_constants();
}

double RayKernel::pipeline_ms() const {
  return impl_->pipeline_ms;
}

}  // namespace promin
