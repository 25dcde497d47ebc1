// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/explain_sample.h"

#include <bit>
#include <utility>

#include "shared/layout.h"

namespace promin {
namespace {

using layout::RayLog;

Ray ray_of(const RayLog& log) {
  return {vec3(log.origin_tmin), log.origin_tmin.w, vec3(log.direction_tmax), log.direction_tmax.w};
}

Hit hit_of(const RayLog& log, const PrimitiveNumbers& numbers) {
  Hit hit;
  const uint32_t order = log.hit.y;
  if (order == layout::NO_ORDER) return hit;
  const PrimitiveId id = primitive_of_order(numbers, order);
  const vec2 weights(std::bit_cast<float>(log.hit.z), std::bit_cast<float>(log.hit.w));
  const vec2 of_triangle = weights_of_triangle(numbers, order, id.object, weights);
  hit.t = std::bit_cast<float>(log.hit.x);
  hit.object = static_cast<int32_t>(id.object);
  hit.primitive = static_cast<int32_t>(id.primitive);
  hit.u = of_triangle.x;
  hit.v = of_triangle.y;
  hit.normal = vec3(log.normal);
  return hit;
}

ExplainedSource source_of(const RayLog& log, const PrimitiveNumbers& numbers, std::span<const uint32_t> light_numbers) {
  ExplainedSource source;
  source.light = light_numbers[log.ids.y];
  if (log.ids.w != 0) source.shadow_ray = ray_of(log);
  source.blocker = hit_of(log, numbers);
  source.contribution = vec3(log.radiance);
  return source;
}

static_assert(static_cast<uint32_t>(RayKind::kReflection) == layout::LOG_REFLECTION &&
              static_cast<uint32_t>(RayKind::kRefraction) == layout::LOG_REFRACTION &&
              static_cast<uint32_t>(RayKind::kThrough) == layout::LOG_THROUGH);

}  // namespace

ExplainedSample explain_sample(std::span<const RayLog> log, const PrimitiveNumbers& numbers,
                               std::span<const uint32_t> light_numbers) {
  ExplainedSample sample;
  std::vector<ExplainedSource> sources;
  // The number of the last ray with each number of bounces.
  std::vector<uint32_t> last_of_bounces;
  for (const RayLog& entry : log) {
    if (entry.ids.x == layout::LOG_SOURCE) {
      sources.push_back(source_of(entry, numbers, light_numbers));
      continue;
    }
    ExplainedRay ray;
    ray.kind = RayKind{entry.ids.w};
    // Paths are followed depth first. A ray therefore starts at the last ray with one bounce less; if it only continues
    // a ray, at the last ray with the same number of bounces.
    const uint32_t bounces = entry.ids.y;
    const uint32_t of_parent = ray.kind == RayKind::kThrough || bounces == 0 ? bounces : bounces - 1;
    last_of_bounces.resize(bounces + size_t{1});
    ray.parent = last_of_bounces[of_parent];
    last_of_bounces[bounces] = static_cast<uint32_t>(sample.rays.size());
    ray.ray = ray_of(entry);
    ray.hit = hit_of(entry, numbers);
    ray.position = vec3(entry.position);
    ray.lift = entry.position.w;
    ray.shading_normal = vec3(entry.shading_normal);
    ray.material = entry.ids.z;
    ray.weight = vec3(entry.weight);
    ray.coverage = entry.weight.w;
    ray.own = vec3(entry.own);
    ray.sources = std::exchange(sources, {});
    ray.radiance = vec3(entry.radiance);
    sample.rays.push_back(std::move(ray));
  }
  return sample;
}

}  // namespace promin
