// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/rounding.h"
#include "hard/hard_case.h"

namespace promin::hard {
namespace {

const size_t kPlaneRayCount = some_of(100000);

/// Judges |dt n.d| / (u (|q - o| + |t d|)); it is infinite if a hit is missing.
Tally judge_plane(const world::Plane& plane, std::span<const Ray> rays, std::span<const Hit> hits) {
  using oracle::Real;
  using oracle::Vector;
  const Vector n(plane.normal);
  Tally tally;
  tally.rays = tally.judged = tally.hits = rays.size();
  for (size_t i = 0; i < rays.size(); ++i) {
    const Vector d(rays[i].direction);
    const Vector to_plane = Vector(plane.point) - Vector(rays[i].origin);
    const Real slope = glm::dot(n, d);
    const Real t = glm::dot(n, to_plane) / slope;
    const Real scale = kUnitRoundoff * (glm::length(to_plane) + t * glm::length(d));
    const auto error = hits[i].object == 0 ? static_cast<double>(std::abs((hits[i].t - t) * slope) / scale)
                                           : std::numeric_limits<double>::infinity();
    tally.max_t_error = std::max(tally.max_t_error, error);
    tally.sum_t_error2 += error * error;
  }
  return tally;
}

void run_slopes(Lab& lab) {
  Random random(10);
  for (const double cosine : {1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const dvec3 normal = random.direction();
    const world::Plane plane{vec3(1e5F, -1e5F, 1e5F), vec3(normal)};
    const dvec3 n = glm::normalize(dvec3(plane.normal));
    std::vector<Ray> rays;
    while (rays.size() < kPlaneRayCount) {
      const double reach = 10.0 * random.uniform();
      const dvec3 origin = dvec3(plane.point) + 10.0 * n + reach * random.perpendicular(n);
      const dvec3 along = std::sqrt(1.0 - cosine * cosine) * random.perpendicular(n);
      const Ray ray = ray_towards(origin, origin - cosine * n + along);
      // Rounding may change the direction so that it points away from the plane.
      const oracle::Real slope = glm::dot(oracle::Vector(plane.normal), oracle::Vector(ray.direction));
      if (slope < -0.5L * cosine) rays.push_back(ray);
    }
    const Tally tally = judge_plane(plane, rays, lab.cast(scene_of({plane}), rays));
    char what[96];
    std::snprintf(what, sizeof what, "|dt n.d| / u(|q-o| + |td|), cos %.0e", cosine);
    lab.expect_at_most(what, 8.0 * lab.rounding_factor(), tally.max_t_error);
    Lab::credit("plane", tally);
  }
}

void run_parallel(Lab& lab) {
  const world::Plane plane{vec3(1.0F, 2.0F, 3.0F), vec3(0.0F, 1.0F, 0.0F)};
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<Ray> rays;
  for (const float height : {2.0F, 2.5F, 1.5F}) {
    for (const float zero : {0.0F, -0.0F}) {
      for (const vec3& direction : {vec3(1, zero, 0), vec3(-1, zero, 2), vec3(zero, zero, -1)}) {
        rays.push_back({vec3(0.0F, height, 0.0F), 0.0F, direction, infinity});
      }
    }
  }
  // The plane is behind this ray.
  rays.push_back({vec3(0.0F, 3.0F, 0.0F), 0.0F, vec3(0.0F, 1.0F, 0.0F), infinity});
  rays.push_back({vec3(0.0F, 1.0F, 0.0F), 0.0F, vec3(5.0F, -1e-20F, 0.0F), infinity});
  const std::vector<Hit> hits = lab.cast(scene_of({plane}), rays);
  const auto is_hit = [](const Hit& hit) { return hit.object >= 0 || !std::isinf(hit.t); };
  lab.expect_at_most("hits of parallel rays and of a plane behind", 0.0,
                     static_cast<double>(std::count_if(hits.begin(), hits.end(), is_hit)));
}

constexpr std::array kPlaneCases{HardCase{10, "PlaneFarFromTheOrigin", run_slopes},
                                 HardCase{11, "ParallelToThePlane", run_parallel}};

}  // namespace

std::span<const HardCase> plane_cases() {
  return kPlaneCases;
}

}  // namespace promin::hard
