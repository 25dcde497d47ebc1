// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/kernel_pair.h"

#include <array>
#include <cmath>
#include <random>

#include "measure/samples.h"

namespace promin::measure {
namespace {

RaySet make_edge_rays(const Mesh& mesh, size_t count) {
  std::mt19937 generator(2);
  RaySet set{"edges", HitQuery::kNearest, {}};
  const vec3 origin(0.1F, 0.05F, -0.07F);
  while (set.rays.size() < count) {
    const uvec3& triangle = mesh.triangles[generator() % mesh.triangles.size()];
    const double s = static_cast<double>(generator()) * 0x1p-32;
    const dvec3 target = glm::mix(dvec3(mesh.positions[triangle.x]), dvec3(mesh.positions[triangle.y]), s);
    set.rays.push_back({origin, 0.0F, vec3(target - dvec3(origin))});
  }
  return set;
}

/// Returns the number of rays that hit in `a` and miss in `b`.
uint64_t count_only(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  uint64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += std::isfinite(a[i].t) && !std::isfinite(b[i].t) ? 1 : 0;
  return count;
}

}  // namespace

uint64_t KernelPair::count_only_robust() const {
  return count_only(robust_hits, plain_hits);
}

uint64_t KernelPair::count_only_plain() const {
  return count_only(plain_hits, robust_hits);
}

KernelPair measure_pair(Caster& robust, Caster& plain, const RaySet& set, uint32_t runs) {
  KernelPair pair;
  pair.rays = set.name;
  pair.count = set.rays.size();
  pair.robust_hits.resize(pair.count);
  pair.plain_hits.resize(pair.count);
  const std::array<std::function<double()>, 2> contestants = {
      [&] { return robust.cast(set.rays, pair.robust_hits, set.query); },
      [&] { return plain.cast(set.rays, pair.plain_hits, set.query); }};
  std::vector<std::vector<double>> times = time_in_turns(contestants, runs);
  pair.robust_ms = std::move(times[0]);
  pair.plain_ms = std::move(times[1]);
  return pair;
}

std::vector<RaySet> make_ray_sets(Caster& caster, const world::Scene& scene, const Camera& camera, uint32_t side,
                                  bool is_closed) {
  std::vector<RaySet> sets = {make_camera_rays(camera, uvec2(side))};
  std::vector<Hit> hits(sets[0].rays.size());
  caster.cast(sets[0].rays, hits);
  sets.push_back(make_shadow_rays(sets[0], hits, scene, camera));
  sets.push_back(make_random_rays(scene, hits.size()));
  if (is_closed) sets.push_back(make_edge_rays(std::get<Mesh>(scene.objects[0].shape), hits.size()));
  return sets;
}

}  // namespace promin::measure
