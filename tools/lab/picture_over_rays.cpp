// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "lab/picture_over_rays.h"

#include <algorithm>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lab/ray_files.h"
#include "measure/picture_rays.h"
#include "measure/samples.h"
#include "trace/render/renderer_impl.h"

namespace promin::lab {
namespace {

using measure::EmbreeCaster;

/// The milliseconds of each turn.
using Times = std::vector<double>;

Times sum_of(std::span<const Times> sets) {
  Times sums(sets.front().size(), 0.0);
  for (const Times& times : sets) std::transform(sums.begin(), sums.end(), times.begin(), sums.begin(), std::plus());
  return sums;
}

Times difference_of(Times a, std::span<const double> b) {
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::minus());
  return a;
}

/// A picture, or the part of its work that traces the rays of these sets.
struct Part {
  std::string what;
  Times ms;
  uint64_t traced_rays;
  std::span<const measure::RaySet> sets;
  std::span<const Times> cast_ms;
  /// Empty if the peer is not installed.
  std::span<const Times> peer_ms;
};

Json json_of(const Part& part) {
  uint64_t count = 0;
  for (const measure::RaySet& set : part.sets) count += set.rays.size();
  const Times rays_ms = sum_of(part.cast_ms);
  Json json = {{"count", count},
               {"traced_rays", part.traced_rays},
               {"promin_ms", part.ms},
               {"rays_ms", rays_ms},
               {"rays_time_ratio", measure::ratios_of(part.ms, rays_ms)}};
  if (!part.peer_ms.empty()) {
    const Times peer_ms = sum_of(part.peer_ms);
    json["peer"] = measure::embree_version();
    json["peer_ms"] = peer_ms;
    json["time_ratio"] = measure::ratios_of(part.ms, peer_ms);
  }
  return json;
}

}  // namespace

void add_picture_over_rays(const Session& session, const world::Scene& scene, Caster& caster, EmbreeCaster* embree,
                           Json& rates) {
  world::Scene lit = scene;
  add_default_lights(lit);
  View view = view_of(lit, uvec2(session.side()));
  view.max_depth = session.options().max_depth;
  const measure::PictureRays rays = measure::make_picture_rays(caster, lit, view);
  std::vector<measure::RaySet> sets = rays.camera_stage;
  sets.insert(sets.end(), rays.mirror_stage.begin(), rays.mirror_stage.end());
  const std::string name = scene.file.stem().string();
  if (session.options().rays) write_sets(*session.options().rays, name, sets);

  TunedRendererOptions options;
  options.builder = session.options().builder;
  Renderer renderer = make_renderer(session.device(), lit, options);
  View without_mirrors = view;
  without_mirrors.max_depth = 0;
  RayCounts whole;
  RayCounts camera_stage;
  const auto render = [&](const View& shown, RayCounts& counts) {
    const RenderResult result = renderer.render(shown);
    counts = result.rays;
    return result.trace_ms;
  };
  std::vector<std::function<double()>> contestants = {[&] { return render(view, whole); },
                                                      [&] { return render(without_mirrors, camera_stage); }};
  std::vector<Hit> hits;
  const auto answers_to = [&](const measure::RaySet& set) {
    hits.resize(set.rays.size());
    return std::span(hits);
  };
  for (const measure::RaySet& set : sets) {
    contestants.emplace_back([&] { return caster.cast(set.rays, answers_to(set), set.query); });
  }
  for (size_t i = 0; embree != nullptr && i < sets.size(); ++i) {
    contestants.emplace_back([&, i] {
      return embree->cast(sets[i].rays, answers_to(sets[i]), sets[i].query, measure::EmbreeCall::kSingle);
    });
  }
  const std::vector<Times> ms = measure::time_in_turns(contestants, session.runs());

  const auto cast_ms = std::span(ms).subspan(2, sets.size());
  const auto peer_ms = std::span(ms).subspan(2 + sets.size());
  const auto add = [&](const std::string& what, const Times& times, uint64_t traced_rays, size_t first) {
    Json row = {
        {"scene", name}, {"what", what}, {"width", view.size.x}, {"height", view.size.y}, {"depth", view.max_depth}};
    row.update(json_of({what, times, traced_rays, std::span(sets).subspan(first), cast_ms.subspan(first),
                        peer_ms.empty() ? peer_ms : peer_ms.subspan(first)}));
    rates["pictures"].push_back(std::move(row));
  };
  for (size_t i = 0; i < sets.size(); ++i) {
    Json row = {{"scene", name}, {"rays", sets[i].name}, {"count", sets[i].rays.size()}, {"promin_ms", cast_ms[i]}};
    if (!peer_ms.empty()) row["peer_ms"] = peer_ms[i];
    rates["picture_rays"].push_back(std::move(row));
  }
  add("picture", ms[0], whole.total(), 0);
  const size_t first = rays.camera_stage.size();
  if (first == sets.size()) return;
  add("mirror stage", difference_of(ms[0], ms[1]), whole.total() - camera_stage.total(), first);
}

}  // namespace promin::lab
