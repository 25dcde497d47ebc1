// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/accuracy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "core/parallel.h"
#include "oracle/distance.h"

namespace promin::report {
namespace {

/// Where a ray meets a rim or a seam, two faces answer for one point: of such solids the distance from the surface is
/// told instead of the error of t.
bool has_rims_or_seams(const world::Shape& shape) {
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (std::holds_alternative<world::TYPE>(shape)) return !std::is_same_v<world::TYPE, world::Sphere>;
#include "promin/kinds/primitives.def"
  return false;
}

void judge_one(const world::Scene& scene, const Ray& ray, const layout::HitRecord& record, Accuracy& accuracy) {
  const oracle::Ray exact_ray{oracle::Vector(ray.origin), oracle::Vector(ray.direction), ray.tmin, ray.tmax};
  const oracle::Hit exact = oracle::find_nearest_hit(scene, exact_ray);
  const float t = std::bit_cast<float>(record.a.x);
  const bool is_hit = record.a.y != layout::NO_ORDER && std::isfinite(t);
  ++accuracy.rays;
  if (is_hit != exact.exists()) {
    ++accuracy.misclassified;
    return;
  }
  if (!is_hit) return;
  const world::Shape& shape = scene.objects[0].shape;
  const bool has_rims = has_rims_or_seams(shape);
  oracle::Real scale = oracle::scale_of(shape, exact.primitive, exact_ray);
  if (std::holds_alternative<world::Plane>(shape)) scale += exact.t * glm::length(exact_ray.direction);
  const oracle::Real error =
      has_rims ? oracle::surface_distance(shape, 0, exact_ray.origin + oracle::Real(t) * exact_ray.direction)
               : std::abs((oracle::Real(t) - exact.t) * glm::dot(exact_ray.direction, exact.normal));
  const auto k = static_cast<double>(error / (oracle::kRoundoff * scale));
  ++accuracy.hits;
  accuracy.max_k = std::max(accuracy.max_k, k);
  accuracy.sum_k2 += k * k;
}

}  // namespace

double Accuracy::rms_k() const {
  return hits > 0 ? std::sqrt(sum_k2 / static_cast<double>(hits)) : 0.0;
}

void Accuracy::add(const Accuracy& other) {
  rays += other.rays;
  hits += other.hits;
  max_k = std::max(max_k, other.max_k);
  sum_k2 += other.sum_k2;
  misclassified += other.misclassified;
}

Accuracy judge_records(const world::Scene& scene, std::span<const Ray> rays,
                       std::span<const layout::HitRecord> records) {
  constexpr size_t kChunk = 1024;
  std::vector<Accuracy> parts((rays.size() + kChunk - 1) / kChunk);
  for_each_chunk(rays.size(), kChunk, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) judge_one(scene, rays[i], records[i], parts[begin / kChunk]);
  });
  Accuracy total;
  for (const Accuracy& part : parts) total.add(part);
  return total;
}

void put_accuracy(Json& row, const Accuracy& accuracy) {
  row["rays"] = accuracy.rays;
  if (accuracy.hits > 0) {
    row["max_k"] = accuracy.max_k;
    row["rms_k"] = accuracy.rms_k();
  }
  row["misclassified_per_million"] =
      1e6 * static_cast<double>(accuracy.misclassified) / static_cast<double>(std::max<uint64_t>(1, accuracy.rays));
}

std::vector<layout::RayRecord> make_requests(std::span<const Ray> rays) {
  std::vector<layout::RayRecord> requests;
  requests.reserve(rays.size());
  for (const Ray& ray : rays) requests.push_back({vec4(ray.origin, ray.tmin), vec4(ray.direction, ray.tmax)});
  return requests;
}

}  // namespace promin::report
