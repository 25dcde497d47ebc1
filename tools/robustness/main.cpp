// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What robustness costs and brings: promin's kernel against one with the plain methods (tools/plain), the same rays
// through the same tree, run in turns.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "core/error.h"
#include "core/file.h"
#include "gpu/open_device.h"
#include "measure/meshes.h"
#include "measure/ray_sets.h"
#include "measure/samples.h"
#include "textbook_cast.spv.h"
#include "render/caster.h"
#include "scene/load_scene.h"

namespace {

using namespace promin;
using namespace promin::measure;

constexpr uint32_t kSide = 1024;
constexpr uint32_t kSphereTriangles = 131000;

/// From inside of the generated sphere at its edges: each must hit.
RaySet make_edge_rays(const Mesh& mesh) {
  std::mt19937 generator(2);
  RaySet set{"edges", HitQuery::kNearest, {}};
  const vec3 origin(0.1F, 0.05F, -0.07F);
  while (set.rays.size() < size_t{kSide} * kSide) {
    const uvec3& triangle = mesh.triangles[generator() % mesh.triangles.size()];
    const double s = static_cast<double>(generator()) * 0x1p-32;
    const dvec3 target = glm::mix(dvec3(mesh.positions[triangle.x]), dvec3(mesh.positions[triangle.y]), s);
    set.rays.push_back({origin, 0.0F, vec3(target - dvec3(origin))});
  }
  return set;
}

struct Comparison {
  std::string rays;
  size_t count = 0;
  double robust_mrays = 0.0;
  double plain_mrays = 0.0;
  /// Rays with a hit by the robust kernel and none by the plain one, and the other way round.
  uint64_t lost = 0;
  uint64_t invented = 0;
};

Comparison compare(Caster& robust, Caster& plain, const RaySet& set, uint32_t runs) {
  std::vector<Hit> robust_hits(set.rays.size());
  std::vector<Hit> plain_hits(set.rays.size());
  std::vector<double> robust_ms;
  std::vector<double> plain_ms;
  robust.prepare(set.query, set.rays);
  plain.prepare(set.query, set.rays);
  for (uint32_t i = 0; i < runs; ++i) {
    robust_ms.push_back(robust.cast(set.rays, robust_hits, set.query));
    plain_ms.push_back(plain.cast(set.rays, plain_hits, set.query));
  }
  const auto mrays = [&](const std::vector<double>& ms) {
    return static_cast<double>(set.rays.size()) / (1e3 * quartiles_of(ms).median);
  };
  Comparison result{set.name, set.rays.size(), mrays(robust_ms), mrays(plain_ms)};
  for (size_t i = 0; i < set.rays.size(); ++i) {
    const bool is_robust_hit = std::isfinite(robust_hits[i].t);
    const bool is_plain_hit = std::isfinite(plain_hits[i].t);
    result.lost += is_robust_hit && !is_plain_hit ? 1 : 0;
    result.invented += is_plain_hit && !is_robust_hit ? 1 : 0;
  }
  return result;
}

nlohmann::ordered_json json_of(const Comparison& c) {
  return {{"rays", c.rays},
          {"count", c.count},
          {"robust_mrays_per_s", c.robust_mrays},
          {"plain_mrays_per_s", c.plain_mrays},
          {"lost", c.lost},
          {"invented", c.invented}};
}

void compare_all(const std::string& file, const std::string& output, uint32_t runs) {
  const Scene scene = file.empty() ? make_wavy_sphere(kSphereTriangles) : load_scene(file);
  const gpu::DeviceHandle device = gpu::open_device();
  const Camera camera = scene.cameras.empty() ? frame_scene(scene, 1.0F) : scene.cameras.front();
  Caster robust(*device, scene);
  CasterOptions options;
  options.spirv = k_textbook_cast_spirv;
  Caster plain(*device, scene, options);

  std::vector<RaySet> sets = {make_camera_rays(camera, kSide)};
  std::vector<Hit> hits(sets[0].rays.size());
  robust.cast(sets[0].rays, hits);
  sets.push_back(make_shadow_rays(sets[0], hits, scene, camera));
  sets.push_back(make_random_rays(scene, hits.size()));
  if (file.empty()) sets.push_back(make_edge_rays(std::get<Mesh>(scene.objects[0].shape)));

  const gpu::DeviceInfo& info = gpu::info_of(*device);
  nlohmann::ordered_json json = {
      {"scene", scene.file.filename().string()}, {"device", info.name}, {"driver", info.driver}, {"runs", runs}};
  fmt::print("{} on {}, medians of {} runs in turns\n", scene.file.filename().string(), info.driver, runs);
  fmt::print("{:<8}{:>10}{:>16}{:>16}{:>8}{:>8}{:>10}\n", "rays", "count", "robust Mray/s", "plain Mray/s", "ratio",
             "lost", "invented");
  for (const RaySet& set : sets) {
    const Comparison c = compare(robust, plain, set, runs);
    json["comparisons"].push_back(json_of(c));
    fmt::print("{:<8}{:>10}{:>16.3f}{:>16.3f}{:>8.2f}{:>8}{:>10}\n", c.rays, c.count, c.robust_mrays, c.plain_mrays,
               c.robust_mrays / c.plain_mrays, c.lost, c.invented);
  }
  if (!output.empty()) write_text_file(output, json.dump(1) + "\n");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("What promin's robust methods cost beside the plain ones of the textbook.", "promin-robustness");
  std::string scene;
  std::string output;
  uint32_t runs = 5;
  program.add_option("SCENE", scene, "Scene file: .gltf, .glb or .obj [a closed mesh of 131,000 triangles]");
  program.add_option("-o,--output", output, "Write the figures as JSON");
  program.add_option("--runs", runs, "Runs of each kernel [5]")->check(CLI::Range(1, 1000));
  CLI11_PARSE(program, argc, argv);
  try {
    compare_all(scene, output, runs);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "promin-robustness: error: {}\n", error.what());
    return 1;
  }
}
