// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/caster.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <optional>
#include <vector>

#include "core/shared_progress.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "promin/validate.h"
#include "rays/ray_order.h"
#include "rays/ray_tiles.h"
#include "render/caster_access.h"
#include "scene/features.h"
#include "trace/ray_kernel.h"

namespace promin {
namespace {

using layout::HitRecord;
using layout::RayRecord;

/// A power of two that brings the direction to where the shader takes it (shaders/make_ray.glsl); mostly 1.
float scale_of(const vec3& direction) {
  // max_abs_component is not used, because its calls of std::fmax took a seventh of the time of `promin cast`.
  const vec3 sizes = glm::abs(direction);
  const float size = std::max(std::max(sizes.x, sizes.y), sizes.z);
  if (size > 0.0F && size < 0x1p-126F) return 0x1p64F;
  if (size >= 0x1p127F && std::isfinite(size)) return 0x1p-64F;
  return 1.0F;
}

RayRecord record_of(const Ray& ray) {
  const float scale = scale_of(ray.direction);
  // tmin * direction is kept. The scaled tmin may round to 0 here; hit_of decides.
  return {vec4(ray.origin, ray.tmin / scale), vec4(ray.direction * scale, ray.tmax / scale)};
}

Hit hit_of(const HitRecord& record, const Ray& ray, HitQuery query, const PrimitiveNumbers& numbers) {
  Hit hit;
  if (record.a.y == layout::NO_ORDER) return hit;
  if (query == HitQuery::kAny) {
    hit.t = 0.0F;
    return hit;
  }
  const float t = std::bit_cast<float>(record.a.x) * scale_of(ray.direction);
  if (!(t > ray.tmin && t < ray.tmax)) return hit;
  const PrimitiveId id = primitive_of_order(numbers, record.a.y);
  hit.t = t;
  hit.object = static_cast<int32_t>(id.object);
  hit.primitive = static_cast<int32_t>(id.primitive);
  const vec2 weights(std::bit_cast<float>(record.a.z), std::bit_cast<float>(record.a.w));
  const vec2 of_triangle = weights_of_triangle(numbers, record.a.y, id.object, weights);
  hit.u = of_triangle.x;
  hit.v = of_triangle.y;
  hit.normal = {std::bit_cast<float>(record.b.x), std::bit_cast<float>(record.b.y), std::bit_cast<float>(record.b.z)};
  return hit;
}

}  // namespace

// Hidden, although the class around it is not (promin/export.h).
struct __attribute__((visibility("hidden"))) Caster::Impl {
  Impl(const gpu::Device& the_device, const world::Scene& the_scene, const TunedCasterOptions& options)
      : device(the_device), spirv(options.spirv.begin(), options.spirv.end()) {
    PackedScene packed = options.bvh ? pack_scene_with(*options.bvh, the_scene)
                                     : pack_scene(the_scene, options.builder, {.progress = options.progress});
    const Stopwatch uploading;
    scene = upload_scene(device, packed);
    stats.upload_ms = uploading.ms();
    stats.bvh = packed.bvh;
    stats.bvh_ms = packed.bvh_ms;
    stats.device_bytes = scene->size_bytes();
    stats.degenerate_triangles = packed.degenerate_count;
    features = packed.features.common_with(primitive_features());
    stats.features = feature_names(features);
    numbers = std::move(packed.numbers);
    cube = {vec3(packed.tree_bounds), packed.tree_bounds.w};
  }

  enum class Order { kAsGiven, kInPackets, kSorted };
  Order order_of(std::span<const Ray> rays) const {
    const bool takes_packets = device.profile().ray_packet_size > 1;
    const bool sorts_rays = device.profile().sorts_rays;
    if (!takes_packets && !sorts_rays) return Order::kAsGiven;
    if (are_side_by_side(rays, cube)) return takes_packets ? Order::kInPackets : Order::kAsGiven;
    return sorts_rays ? Order::kSorted : Order::kAsGiven;
  }

  /// Empty where the rays are traced as they come.
  std::span<const uint32_t> permutation_of(std::span<const Ray> rays, Order order) {
    if (order == Order::kInPackets) return tiler.tile(rays, cube);
    if (order == Order::kSorted) return sorter.sort(rays, cube);
    return {};
  }

  RayKernel& kernel_for(HitQuery query, Order order) {
    const bool is_packet = order == Order::kInPackets;
    std::optional<RayKernel>& kernel = kernels[query == HitQuery::kAny ? 1 : 0][is_packet ? 1 : 0];
    if (!kernel) {
      RayKernelOptions options;
      options.features = features;
      options.query = query;
      options.packet_size = is_packet ? device.profile().ray_packet_size : 1;
      if (!spirv.empty()) options.spirv = spirv;
      kernel.emplace(device, scene, options);
      stats.pipeline_ms += kernel->pipeline_ms();
    }
    return *kernel;
  }

  /// Casts at most RayKernel::kMaxRays rays.
  double cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query) {
    const Stopwatch ordering;
    const Order order = order_of(rays);
    const std::span<const uint32_t> permutation = permutation_of(rays, order);
    double time_ms = ordering.ms();
    RayKernel& kernel = kernel_for(query, order);
    const auto place_of = [&](size_t i) { return permutation.empty() ? i : permutation[i]; };
    requests.resize(rays.size());
    records.resize(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) requests[i] = record_of(rays[place_of(i)]);
    time_ms += kernel.run(requests, records);
    for (size_t i = 0; i < rays.size(); ++i) {
      const size_t place = place_of(i);
      hits[place] = hit_of(records[i], rays[place], query, numbers);
    }
    return time_ms;
  }

  const gpu::Device& device;
  /// This is a copy, because kernels are compiled as they are needed.
  std::vector<uint32_t> spirv;
  std::shared_ptr<const DeviceScene> scene;
  PrimitiveNumbers numbers;
  FeatureMask features;
  SetupStats stats;
  SceneCube cube;
  std::array<std::array<std::optional<RayKernel>, 2>, 2> kernels;
  RaySorter sorter;
  RayTiler tiler;
  /// What is asked and answered for the rays at hand, in the order in which they are traced.
  std::vector<RayRecord> requests;
  std::vector<HitRecord> records;
};

Caster::Caster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Caster::Caster(const gpu::Device& device, const Scene& scene, const CasterOptions& options) {
  throw_if_invalid(scene);
  impl_ = std::make_unique<Impl>(device, world::flatten(scene, world::Purpose::kHits), TunedCasterOptions{options, {}});
}
Caster::~Caster() = default;
Caster::Caster(Caster&&) noexcept = default;
Caster& Caster::operator=(Caster&&) noexcept = default;

void Caster::prepare(HitQuery query, std::span<const Ray> rays) {
  impl_->kernel_for(query, impl_->order_of(rays));
}

double Caster::cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query, const ProgressCallback& progress) {
  if (rays.size() != hits.size()) {
    throw UsageError({"there are " + std::to_string(hits.size()) + " hits for " + std::to_string(rays.size()) + " rays",
                      "in Caster::cast", "give as many hits as rays"});
  }
  double time_ms = 0.0;
  for (size_t first = 0; first < rays.size(); first += RayKernel::kMaxRays) {
    const size_t count = std::min(RayKernel::kMaxRays, rays.size() - first);
    time_ms += impl_->cast(rays.subspan(first, count), hits.subspan(first, count), query);
    tell_progress(progress, static_cast<double>(first + count) / static_cast<double>(rays.size()));
  }
  return time_ms;
}

Caster CasterAccess::make(const gpu::Device& device, const world::Scene& scene, const TunedCasterOptions& options) {
  return Caster(std::make_unique<Caster::Impl>(device, scene, options));
}

const SetupStats& Caster::setup_stats() const {
  return impl_->stats;
}

}  // namespace promin
