// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Beside other renderers: Embree's rays, Tachyon's and POV-Ray's pictures.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "measure/embree.h"
#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "reporting/scene_hash.h"
#include "reporting/scripts.h"

namespace promin::report {
namespace {

/// Rays with a hit by one and none by the other.
uint64_t count_differences(std::span<const Hit> a, std::span<const Hit> b) {
  uint64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += std::isfinite(a[i].t) != std::isfinite(b[i].t) ? 1 : 0;
  return count;
}

void compare_with_embree(const Session& session, const Scene& scene, Json& rows, Json& gaps) {
  const std::unique_ptr<measure::EmbreeCaster> embree = measure::make_embree_caster(scene);
  if (embree == nullptr) {
    gaps.push_back(json_of_gap("Embree", std::nullopt));
    return;
  }
  session.say("peers: Embree, " + session.name_of(scene));
  Caster caster(session.device(), scene);
  const uint32_t side = session.pick(512U, 96U);
  const std::string hash = hash_of(scene);
  for (const measure::RaySet& set :
       measure::make_ray_sets(caster, scene, view_of(scene, uvec2(side)).camera, side, false)) {
    std::vector<Hit> own(set.rays.size());
    std::vector<Hit> single(set.rays.size());
    std::vector<Hit> packets(set.rays.size());
    const std::array<std::function<double()>, 3> contestants = {
        [&] { return caster.cast(set.rays, own, set.query); },
        [&] { return embree->cast(set.rays, single, set.query, measure::EmbreeCall::kSingle); },
        [&] { return embree->cast(set.rays, packets, set.query, measure::EmbreeCall::kPackets); }};
    const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, session.runs());
    rows.push_back({{"id", fmt::format("{}/{}/Embree", scene.file.string(), set.name)},
                    {"scene", scene.file.string()},
                    {"scene_hash", hash},
                    {"peer", measure::embree_version()},
                    {"what", set.name + " rays"},
                    {"count", set.rays.size()},
                    {"promin_ms", json_of_times(ms[0])},
                    {"peer_ms", json_of_times(ms[1])},
                    {"peer_packets_ms", json_of_times(ms[2])},
                    {"time_ratio", json_of_times(measure::ratios_of(ms[0], ms[1]))},
                    {"differing_hits", count_differences(own, single)}});
  }
}

std::vector<double> values_of(const Json& array) {
  return array.get<std::vector<double>>();
}

/// Each peer that is measured as a row, each that is not as a gap.
void compare_pictures(const Session& session, Json& rows, Json& gaps) {
  session.say("peers: Tachyon and POV-Ray, sphereflake");
  const uint32_t side = session.pick(1024U, 64U);
  const uint32_t level = session.pick(4U, 2U);
  std::vector<std::string> arguments = {
      "--programs", std::filesystem::read_symlink("/proc/self/exe").parent_path().string(),
      "--runs",     std::to_string(session.runs()),
      "--side",     std::to_string(side),
      "--level",    std::to_string(level)};
  if (session.options().device) arguments.insert(arguments.end(), {"--device", *session.options().device});
  const ScriptResult found = run_script("peers.py", arguments);
  for (const std::string name : {"Tachyon", "POV-Ray"}) {
    if (found.failure) {
      gaps.push_back(json_of_gap(name, found.failure));
      continue;
    }
    const Json& failures = found.json.at("failures");
    if (!found.json.at("peers").contains(name)) {
      gaps.push_back(
          json_of_gap(name, failures.contains(name) ? std::optional(failures[name].get<std::string>()) : std::nullopt));
      continue;
    }
    const Json& peer = found.json["peers"][name];
    const std::vector<double> own_ms = values_of(found.json["trace_ms"]);
    const std::vector<double> peer_ms = values_of(peer["trace_ms"]);
    rows.push_back({{"id", fmt::format("sphereflake:{}/picture/{}", level, name)},
                    {"scene", fmt::format("sphereflake:{}", level)},
                    {"scene_hash", found.json["scene_hash"]},
                    {"peer", peer["version"]},
                    {"what", fmt::format("a picture of {} by {} pixels, 6 bounces", side, side)},
                    {"promin_ms", json_of_times(own_ms)},
                    {"peer_ms", json_of_times(peer_ms)},
                    {"time_ratio", json_of_times(measure::ratios_of(own_ms, peer_ms))},
                    {"mean_difference", peer["picture_difference"]["mean_absolute"]},
                    {"different_pixels_percent", peer["picture_difference"]["different_percent"]}});
  }
}

}  // namespace

Json measure_peers(const Session& session) {
  Json rows = Json::array();
  Json gaps = Json::array();
  const uint32_t triangles = session.pick(70'000U, 5'000U);
  Scene mesh = measure::make_wavy_sphere(triangles);
  mesh.file = fmt::format("wavy:{}", triangles);
  compare_with_embree(session, mesh, rows, gaps);
  compare_pictures(session, rows, gaps);
  return {{"rows", rows}, {"gaps", gaps}};
}

}  // namespace promin::report
