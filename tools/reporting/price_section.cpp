// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What robustness costs, and what modelling only what a scene needs brings.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "render/renderer.h"
#include "reporting/provenance.h"
#include "textbook_cast.spv.h"

namespace promin::report {
namespace {

void compare_casters(const Session& session, const Scene& scene, bool is_closed, Json& rows) {
  session.say("robustness: " + name_of(scene));
  Caster robust(session.device(), scene);
  CasterOptions options;
  options.spirv = k_textbook_cast_spirv;
  Caster plain(session.device(), scene, options);
  const uint32_t side = session.pick(512U, 96U);
  const Camera camera = view_of(scene, uvec2(side)).camera;
  const std::string hash = hash_of(pack_scene(scene, "sah"));
  for (const measure::RaySet& set : measure::make_ray_sets(robust, scene, camera, side, is_closed)) {
    if (set.rays.empty()) continue;
    const measure::KernelPair pair = measure::measure_pair(robust, plain, set, session.runs());
    rows.push_back({{"id", name_of(scene) + "/" + pair.rays},
                    {"scene", name_of(scene)},
                    {"scene_hash", hash},
                    {"rays", pair.rays},
                    {"count", pair.count},
                    {"robust_ms", json_of_times(pair.robust_ms)},
                    {"plain_ms", json_of_times(pair.plain_ms)},
                    {"time_ratio", json_of_times(measure::ratios_of(pair.robust_ms, pair.plain_ms))},
                    {"robust_mrays_per_s", pair.robust_mrays_per_s()},
                    {"plain_mrays_per_s", pair.plain_mrays_per_s()},
                    {"lost", pair.lost},
                    {"invented", pair.invented}});
  }
}

bool has_same_bits(const Image& a, const Image& b) {
  return a.size == b.size && std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(vec3)) == 0;
}

/// Milliseconds of compiling, on a device that has compiled nothing: Mesa's cache on disk is told to stand aside.
double time_compiling(const Session& session, const Scene& scene, const RendererOptions& options) {
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  const gpu::DeviceHandle device = gpu::open_device(session.options().device);
  unsetenv("MESA_SHADER_CACHE_DISABLE");
  return Renderer(*device, scene, options).setup_stats().pipeline_ms;
}

Json compare_specialisation(const Session& session, const Scene& scene) {
  session.say("specialisation: " + name_of(scene));
  RendererOptions forced;
  forced.force_all_features = true;
  Renderer specialised(session.device(), scene);
  Renderer general(session.device(), scene, forced);
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
  // It takes seconds: fewer runs, and each figure tells how many.
  const uint32_t compile_runs = session.pick(std::min(5U, session.runs()), 1U);
  const std::vector<std::vector<double>> compile_ms = measure::time_in_turns(compiling, compile_runs);
  return {{"id", name_of(scene)},
          {"scene", name_of(scene)},
          {"scene_hash", hash_of(pack_scene(scene, "sah"))},
          {"features", feature_names(features_of(scene)).size()},
          {"all_features", feature_names(all_features()).size()},
          {"ms", json_of_times(ms[0])},
          {"ms_with_all", json_of_times(ms[1])},
          {"time_ratio", json_of_times(measure::ratios_of(ms[0], ms[1]))},
          {"compile_ms", json_of_times(compile_ms[0])},
          {"compile_ms_with_all", json_of_times(compile_ms[1])},
          {"compile_time_ratio", json_of_times(measure::ratios_of(compile_ms[0], compile_ms[1]))},
          {"is_bit_identical", has_same_bits(of_scene, of_all)}};
}

}  // namespace

Json measure_robustness(const Session& session) {
  Json rows = Json::array();
  if (session.options().scenes.empty()) {
    const uint32_t triangles = session.pick(131000U, 10000U);
    Scene mesh = measure::make_wavy_sphere(triangles);
    mesh.file = fmt::format("wavy:{}", triangles);
    compare_casters(session, mesh, true, rows);
  }
  for (const Scene& scene : session.load_scenes(session.pick<std::vector<std::string>>(
           {"all_primitives.gltf", "showcase.gltf", "sphereflake.gltf"}, {"all_primitives.gltf"}))) {
    compare_casters(session, scene, false, rows);
  }
  return {{"rows", rows}};
}

Json measure_specialisation(const Session& session) {
  Json rows = Json::array();
  for (const Scene& scene : session.load_scenes(session.pick<std::vector<std::string>>(
           {"sphere.gltf", "triangles_sharp.gltf", "mirrors.gltf", "all_primitives.gltf", "showcase.gltf"},
           {"sphere.gltf"}))) {
    rows.push_back(compare_specialisation(session, scene));
  }
  return {{"rows", rows}};
}

}  // namespace promin::report
