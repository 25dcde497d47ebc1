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

double mrays_per_s(size_t count, const std::vector<double>& ms) {
  return static_cast<double>(count) / (1e3 * quartiles_of(ms).median);
}

}  // namespace

double KernelPair::robust_mrays_per_s() const {
  return mrays_per_s(count, robust_ms);
}

double KernelPair::plain_mrays_per_s() const {
  return mrays_per_s(count, plain_ms);
}

KernelPair measure_pair(Caster& robust, Caster& plain, const RaySet& set, uint32_t runs) {
  std::vector<Hit> robust_hits(set.rays.size());
  std::vector<Hit> plain_hits(set.rays.size());
  const std::array<std::function<double()>, 2> contestants = {
      [&] { return robust.cast(set.rays, robust_hits, set.query); },
      [&] { return plain.cast(set.rays, plain_hits, set.query); }};
  const std::vector<std::vector<double>> times = time_in_turns(contestants, runs);
  KernelPair pair{set.name, set.rays.size(), times[0], times[1]};
  for (size_t i = 0; i < set.rays.size(); ++i) {
    const bool is_robust_hit = std::isfinite(robust_hits[i].t);
    const bool is_plain_hit = std::isfinite(plain_hits[i].t);
    pair.lost += is_robust_hit && !is_plain_hit ? 1 : 0;
    pair.invented += is_plain_hit && !is_robust_hit ? 1 : 0;
  }
  return pair;
}

std::vector<RaySet> make_ray_sets(Caster& caster, const Scene& scene, const Camera& camera, uint32_t side,
                                  bool is_closed) {
  std::vector<RaySet> sets = {make_camera_rays(camera, side)};
  std::vector<Hit> hits(sets[0].rays.size());
  caster.cast(sets[0].rays, hits);
  sets.push_back(make_shadow_rays(sets[0], hits, scene, camera));
  sets.push_back(make_random_rays(scene, hits.size()));
  if (is_closed) sets.push_back(make_edge_rays(std::get<Mesh>(scene.objects[0].shape), hits.size()));
  return sets;
}

}  // namespace promin::measure
