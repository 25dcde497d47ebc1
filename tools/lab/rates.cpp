// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "lab/rates.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "device_scene/pack_scene.h"
#include "lab/picture_over_rays.h"
#include "lab/ray_files.h"
#include "measure/embree.h"
#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "measure/step_counts.h"
#include "trace/render/caster_access.h"

namespace promin::lab {
namespace {

using measure::EmbreeCaster;

/// Returns the number of rays that hit in one answer and miss in the other.
uint64_t count_differences(std::span<const Hit> a, std::span<const Hit> b) {
  uint64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += std::isfinite(a[i].t) != std::isfinite(b[i].t) ? 1 : 0;
  return count;
}

void time_rays(Caster& caster, EmbreeCaster* embree, const measure::RaySet& set, uint32_t runs, Json& row) {
  std::vector<Hit> own(set.rays.size());
  std::vector<Hit> single(set.rays.size());
  std::vector<Hit> packets(set.rays.size());
  std::vector<std::function<double()>> contestants = {[&] { return caster.cast(set.rays, own, set.query); }};
  if (embree != nullptr) {
    contestants.emplace_back([&] { return embree->cast(set.rays, single, set.query, measure::EmbreeCall::kSingle); });
    contestants.emplace_back([&] { return embree->cast(set.rays, packets, set.query, measure::EmbreeCall::kPackets); });
  }
  const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, runs);
  row["promin_ms"] = ms[0];
  if (embree == nullptr) return;
  row["peer"] = measure::embree_version();
  row["peer_ms"] = ms[1];
  row["peer_packets_ms"] = ms[2];
  row["time_ratio"] = measure::ratios_of(ms[0], ms[1]);
  row["packets_time_ratio"] = measure::ratios_of(ms[0], ms[2]);
  row["differing_hits"] = count_differences(own, single);
}

/// Measures the time from triangles in memory until all is copied to the device, and the builder's time within it.
void time_builds(const world::Scene& scene, const std::string& builder, EmbreeCaster* embree, uint32_t runs,
                 Json& row) {
  std::vector<double> bvh_ms;
  std::vector<std::function<double()>> contestants = {[&] {
    const Stopwatch packing;
    bvh_ms.push_back(pack_scene(scene, builder).bvh_ms);
    return packing.ms();
  }};
  if (embree != nullptr) contestants.emplace_back([&] { return embree->time_build(); });
  const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, runs);
  bvh_ms.erase(bvh_ms.begin());  // drops the time of the warm-up
  row["promin_ms"] = ms[0];
  row["bvh_ms"] = bvh_ms;
  if (embree == nullptr) return;
  row["peer"] = measure::embree_version();
  row["peer_ms"] = ms[1];
  row["time_ratio"] = measure::ratios_of(ms[0], ms[1]);
  row["bvh_time_ratio"] = measure::ratios_of(bvh_ms, ms[1]);
}

}  // namespace

void add_rates(const Session& session, const world::Scene& scene, Json& rates) {
  const std::string name = scene.file.stem().string();
  const std::string& builder = session.options().builder;
  const uint32_t runs = session.runs();
  const std::unique_ptr<EmbreeCaster> embree = runs > 0 ? measure::make_embree_caster(scene) : nullptr;
  TunedCasterOptions options;
  options.builder = builder;
  Caster caster = make_caster(session.device(), scene, options);

  const SetupStats& setup = caster.setup_stats();
  uint64_t primitives = 0;
  for (const world::Object& object : scene.objects) primitives += primitive_count(object.shape);
  Json build = {
      {"scene", name},
      {"primitives", primitives},
      {"builder", builder},
      {"nodes", setup.bvh.nodes},
      {"depth", setup.bvh.depth},
      {"sah_cost", setup.bvh.sah_cost},
      {"device_bytes_per_primitive", static_cast<double>(setup.device_bytes) / static_cast<double>(primitives)}};
  if (runs > 0) time_builds(scene, builder, embree.get(), runs, build);
  rates["builds"].push_back(std::move(build));

  const measure::StepCounter counter(session.device(), scene, builder);
  const Camera camera = view_of(scene, uvec2(session.side())).camera;
  const std::vector<measure::RaySet> sets = measure::make_ray_sets(caster, scene, camera, session.side(), false);
  if (const auto& folder = session.options().rays; folder && runs > 0) {
    write_sets(*folder, name + "_rates", sets);
    write_triangles(*folder, name, scene);
  }
  for (const measure::RaySet& set : sets) {
    const measure::StepCounts counts = counter.count(set);
    const auto rays = static_cast<double>(std::max<uint64_t>(1, counts.rays));
    Json row = {{"scene", name},
                {"rays", set.name},
                {"count", counts.rays},
                {"hits", counts.hits},
                {"node_steps_per_ray", static_cast<double>(counts.node_steps) / rays},
                {"primitive_tests_per_ray", static_cast<double>(counts.primitive_tests) / rays}};
    if (runs > 0 && !set.rays.empty()) time_rays(caster, embree.get(), set, runs, row);
    rates["rows"].push_back(std::move(row));
  }
  if (runs > 0 && primitives > 0) add_picture_over_rays(session, scene, caster, embree.get(), rates);
}

}  // namespace promin::lab
