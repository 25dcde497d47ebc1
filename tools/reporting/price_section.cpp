// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What robustness costs, and what modelling only what a scene needs brings.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "promin/renderer.h"
#include "render/caster_access.h"
#include "render/renderer_impl.h"
#include "reporting/misjudged.h"
#include "reporting/scene_hash.h"
#include "reporting/session.h"
#include "textbook_cast.spv.h"

namespace promin::report {
namespace {

/// "promin_lost" and the like.
void put_misjudged(Json& row, const std::string& kernel, const Misjudged& misjudged) {
  row[kernel + "_lost"] = misjudged.lost;
  row[kernel + "_invented"] = misjudged.invented;
  if (std::isfinite(misjudged.worst_margin)) row[kernel + "_worst_margin"] = misjudged.worst_margin;
}

/// Whom the truth is asked of, and what both kernels come to by it.
void judge_pair(const Session& session, const world::Scene& scene, const measure::RaySet& set,
                const measure::KernelPair& pair, bool is_inside, Json& row) {
  if (is_inside) {
    row["truth"] = "each hits";
    row["judged"] = pair.count;
    put_misjudged(row, "promin", judge_in_closed_mesh(pair.robust_hits));
    put_misjudged(row, "textbook", judge_in_closed_mesh(pair.plain_hits));
    return;
  }
  uint64_t primitives = 0;
  for (const world::Object& object : scene.objects) primitives += primitive_count(object.shape);
  const std::vector<size_t> chosen =
      choose_rays(pair.robust_hits, pair.plain_hits, primitives, session.pick(50'000'000U, 2'000'000U));
  row["truth"] = "oracle";
  row["judged"] = chosen.size();
  const std::vector<uint8_t> is_there = ask_oracle(scene, set.rays, chosen);
  put_misjudged(row, "promin", judge_by_oracle(scene, set.rays, pair.robust_hits, chosen, is_there));
  put_misjudged(row, "textbook", judge_by_oracle(scene, set.rays, pair.plain_hits, chosen, is_there));
}

void compare_casters(const Session& session, const world::Scene& scene, Json& rows) {
  const std::string name = session.name_of(scene);
  const bool is_closed = measure::is_generated_and_closed(scene);
  session.say("robustness: " + name);
  Caster robust = make_caster(session.device(), scene);
  TunedCasterOptions options;
  options.spirv = k_textbook_cast_spirv;
  Caster plain = make_caster(session.device(), scene, options);
  const uint32_t side = session.side();
  const Camera camera = view_of(scene, uvec2(side)).camera;
  const std::string hash = hash_of(scene);
  for (const measure::RaySet& set : measure::make_ray_sets(robust, scene, camera, side, is_closed)) {
    if (set.rays.empty()) continue;
    const measure::KernelPair pair = measure::measure_pair(robust, plain, set, session.runs());
    Json row = {
        {"id", name + "/" + pair.rays},
        {"scene", name},
        {"scene_hash", hash},
        {"rays", pair.rays},
        {"count", pair.count},
        {"differing", pair.count_only_robust() + pair.count_only_plain()},
        {"only_promin_hits", pair.count_only_robust()},
        {"only_textbook_hits", pair.count_only_plain()},
        {"robust_ms", pair.robust_ms},
        {"plain_ms", pair.plain_ms},
        {"time_ratio", measure::ratios_of(pair.robust_ms, pair.plain_ms)},
    };
    judge_pair(session, scene, set, pair, is_closed && set.name == "edges", row);
    rows.push_back(std::move(row));
  }
}

bool has_same_bits(const Image& a, const Image& b) {
  return a.size == b.size && std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(vec3)) == 0;
}

/// Milliseconds of compiling, on a device that has compiled nothing: Mesa's cache on disk is told to stand aside.
double time_compiling(const Session& session, const world::Scene& scene, const TunedRendererOptions& options) {
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  const gpu::DeviceHandle device = gpu::open_device(session.options().device);
  unsetenv("MESA_SHADER_CACHE_DISABLE");
  return make_renderer(*device, scene, options).setup_stats().pipeline_ms;
}

Json compare_specialisation(const Session& session, const world::Scene& scene) {
  const std::string name = session.name_of(scene);
  session.say("specialisation: " + name);
  TunedRendererOptions forced;
  forced.force_all_features = true;
  Renderer specialised = make_renderer(session.device(), scene);
  Renderer general = make_renderer(session.device(), scene, forced);
  const View view = view_of(scene, session.pick(uvec2(320, 180), uvec2(128, 72)));
  Image of_scene;
  Image of_all;
  const auto render = [&](Renderer& renderer, Image& image) {
    RenderResult result = renderer.render(view);
    image = std::move(result.image);
    return result.trace_ms;
  };
  const std::array<std::function<double()>, 2> rendering = {[&] { return render(specialised, of_scene); },
                                                            [&] { return render(general, of_all); }};
  const std::vector<std::vector<double>> ms = measure::time_in_turns(rendering, session.runs());
  const std::array<std::function<double()>, 2> compiling = {[&] { return time_compiling(session, scene, {}); },
                                                            [&] { return time_compiling(session, scene, forced); }};
  const std::vector<std::vector<double>> compile_ms = measure::time_in_turns(compiling, session.few_runs());
  return {{"id", name},
          {"scene", name},
          {"scene_hash", hash_of(scene)},
          {"features", feature_names(features_of(scene)).size()},
          {"all_features", feature_names(all_features()).size()},
          {"ms", ms[0]},
          {"ms_with_all", ms[1]},
          {"time_ratio", measure::ratios_of(ms[0], ms[1])},
          {"compile_ms", json_of_few(compile_ms[0])},
          {"compile_ms_with_all", json_of_few(compile_ms[1])},
          {"compile_time_ratio", json_of_few(measure::ratios_of(compile_ms[0], compile_ms[1]))},
          {"is_bit_identical", has_same_bits(of_scene, of_all)}};
}

}  // namespace

Json measure_robustness(const Session& session) {
  Json rows = Json::array();
  for (const world::Scene& scene : session.open_scenes(session.pick<std::vector<std::string>>(
           {"wavy:131000", "all_primitives.gltf", "showcase.gltf", "sphereflake.gltf"},
           {"wavy:10000", "all_primitives.gltf"}))) {
    compare_casters(session, scene, rows);
  }
  return {{"rows", rows}};
}

Json measure_specialisation(const Session& session) {
  Json rows = Json::array();
  for (const world::Scene& scene : session.load_scenes(session.pick<std::vector<std::string>>(
           {"sphere.gltf", "triangles_sharp.gltf", "mirrors.gltf", "all_primitives.gltf", "showcase.gltf"},
           {"sphere.gltf"}))) {
    rows.push_back(compare_specialisation(session, scene));
  }
  return {{"rows", rows}};
}

}  // namespace promin::report
