// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "hard/bouncer.h"

#include <bit>

#include "bvh/builder.h"
#include "hard/hard_case.h"

namespace promin::hard {
namespace {

RayKernelOptions options_for(FeatureMask features) {
  RayKernelOptions options;
  options.features = features;
  options.spirv = Lab::bounce_kernel();
  return options;
}

}  // namespace

Bouncer::Bouncer(const gpu::Device& device, const world::Scene& scene)
    : Bouncer(device, pack_scene(scene, builder_names().front()), features_of(scene)) {}

Bouncer::Bouncer(const gpu::Device& device, PackedScene packed, FeatureMask features)
    : numbers_(packed.numbers), kernel_(device, upload_scene(device, packed), options_for(features)) {}

std::vector<Bounce> Bouncer::bounce(std::span<const Ray> rays) {
  std::vector<layout::RayRecord> requests;
  for (const Ray& ray : rays) requests.push_back({vec4(ray.origin, ray.tmin), vec4(ray.direction, ray.tmax)});
  std::vector<layout::HitRecord> records(rays.size());
  kernel_.run(requests, records);
  std::vector<Bounce> bounces;
  for (const layout::HitRecord& record : records) {
    const auto number = [](uint32_t bits) { return std::bit_cast<float>(bits); };
    const bool is_hit = record.b.w != layout::NO_ORDER;
    bounces.push_back({is_hit,
                       is_hit ? primitive_of_order(numbers_, record.b.w) : PrimitiveId{},
                       {number(record.a.x), number(record.a.y), number(record.a.z)},
                       number(record.a.w),
                       {number(record.b.x), number(record.b.y), number(record.b.z)}});
  }
  return bounces;
}

}  // namespace promin::hard
