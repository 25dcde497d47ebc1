// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "hard/self_hits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hard/bouncer.h"

namespace promin::hard {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();

}  // namespace

double uniform_cosine(Random& random) {
  return std::pow(10.0, random.uniform(-6.0, 0.0));
}

vec3 direction_at(const dvec3& normal, double cosine, Random& random) {
  return vec3(cosine * normal + std::sqrt(1.0 - cosine * cosine) * random.perpendicular(normal));
}

uint64_t count_self_hits(const Lab& lab, const world::Shape& shape, double scale, const dvec3& center, Random& random) {
  const world::Scene scene = scene_of({shape});
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    const dvec3 origin = center + 4.0 * scale * random.direction();
    rays.push_back(ray_towards(origin, center + 0.8 * scale * random.direction()));
  }
  const std::vector<Hit> hits = lab.cast(scene, rays);
  const std::vector<Bounce> bounces = Bouncer(lab.device(), scene).bounce(rays);
  std::vector<Ray> next;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (!bounces[i].is_hit || hits[i].object < 0) continue;
    const dvec3 n = glm::normalize(dvec3(hits[i].normal));
    const dvec3 facing = glm::dot(n, dvec3(rays[i].direction)) > 0.0 ? -n : n;
    next.push_back({bounces[i].origin, 0.0F, bounces[i].mirrored, kUnbounded});
    for (int k = 0; k < 3; ++k) {
      next.push_back({bounces[i].origin, 0.0F, direction_at(facing, uniform_cosine(random), random), kUnbounded});
    }
  }
  EXPECT_GT(next.size(), 100U) << "four for each ray that meets the shape, of which a thin one takes few";
  const std::vector<Hit> again = lab.cast(scene, next);
  return static_cast<uint64_t>(
      std::count_if(again.begin(), again.end(), [](const Hit& hit) { return hit.object >= 0; }));
}

}  // namespace promin::hard
