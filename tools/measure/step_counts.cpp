// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/step_counts.h"

#include <algorithm>

#include "trace/kernels/ray_kernel.h"

namespace promin::measure {

StepCounter::StepCounter(const gpu::Device& device, const world::Scene& scene, std::string_view builder)
    : device_(device),
      features_(features_of(scene) | layout::FEATURE_STEP_COUNTS),
      scene_(upload_scene(device, pack_scene(scene, builder))) {}

StepCounts StepCounter::count(const RaySet& set) const {
  RayKernelOptions options;
  options.features = features_;
  options.query = set.query;
  RayKernel kernel(device_, scene_, options);
  StepCounts counts;
  counts.rays = set.rays.size();
  std::vector<layout::RayRecord> requests;
  std::vector<layout::HitRecord> records;
  for (size_t first = 0; first < set.rays.size(); first += RayKernel::kMaxRays) {
    const size_t count = std::min(RayKernel::kMaxRays, set.rays.size() - first);
    requests.clear();
    for (const Ray& ray : std::span(set.rays).subspan(first, count)) {
      requests.push_back({vec4(ray.origin, ray.tmin), vec4(ray.direction, ray.tmax)});
    }
    records.resize(count);
    kernel.run(requests, records);
    for (const layout::HitRecord& record : records) {
      counts.hits += record.a.y != layout::NO_ORDER ? 1 : 0;
      counts.node_steps += record.b.w & 0xFFFFU;
      counts.primitive_tests += record.b.w >> 16;
    }
  }
  return counts;
}

}  // namespace promin::measure
