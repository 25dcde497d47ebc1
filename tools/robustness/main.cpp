// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What robustness costs and brings: promin's kernel against one with the plain methods (tools/plain), the same rays
// through the same tree, run in turns.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "core/error.h"
#include "core/file.h"
#include "gpu/open_device.h"
#include "plain_cast.spv.h"
#include "render/caster.h"
#include "scene/load_scene.h"

namespace {

using namespace promin;

constexpr uint32_t kSide = 1024;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Rays of one kind and what is asked of them.
struct RaySet {
  std::string name;
  HitQuery query = HitQuery::kNearest;
  std::vector<Ray> rays;
};

RaySet make_camera_rays(const Camera& camera) {
  const dvec3 look(camera.look);
  const dvec3 up(camera.up);
  const dvec3 right = glm::cross(look, up);
  const double pixel = 2.0 * std::tan(0.5 * static_cast<double>(camera.yfov)) / kSide;
  RaySet set{"camera", HitQuery::kNearest, {}};
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      const dvec3 on_film = pixel * ((x + 0.5 - 0.5 * kSide) * right - (y + 0.5 - 0.5 * kSide) * up);
      set.rays.push_back({camera.eye, 0.0F, vec3(look + on_film), kInfinity});
    }
  }
  return set;
}

/// From the visible points, a little off them, to a point light beside the eye.
RaySet make_shadow_rays(const RaySet& camera_rays, std::span<const Hit> hits, const Camera& camera, float scene_size) {
  const vec3 light = camera.eye + scene_size * (camera.up + glm::cross(camera.look, camera.up));
  RaySet set{"shadow", HitQuery::kAny, {}};
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].object < 0) continue;
    const Ray& ray = camera_rays.rays[i];
    const vec3 facing = glm::dot(hits[i].normal, ray.direction) > 0.0F ? -hits[i].normal : hits[i].normal;
    const vec3 origin = ray.origin + hits[i].t * ray.direction + 1e-4F * scene_size * facing;
    set.rays.push_back({origin, 0.0F, light - origin, 1.0F});
  }
  return set;
}

/// Chords between uniform points of the sphere around the scene.
RaySet make_random_rays(const Bounds& bounds) {
  std::mt19937 generator(1);
  const auto uniform = [&] { return static_cast<double>(generator()) * 0x1p-32; };
  const dvec3 center(bounds.center());
  const double radius = 0.5 * glm::length(dvec3(bounds.extent()));
  const auto point = [&] {
    const double z = 2.0 * uniform() - 1.0;
    const double angle = 6.283185307179586 * uniform();
    const double r = std::sqrt(1.0 - z * z);
    return center + radius * dvec3(r * std::cos(angle), r * std::sin(angle), z);
  };
  RaySet set{"random", HitQuery::kNearest, {}};
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const vec3 origin(point());
    set.rays.push_back({origin, 0.0F, vec3(point() - dvec3(origin)), kInfinity});
  }
  return set;
}

/// A closed surface around the origin with waves on it, of 4 * kRings * kRings triangles.
constexpr uint32_t kRings = 181;
Scene make_wavy_sphere() {
  Mesh mesh;
  const uint32_t columns = 2 * kRings;
  mesh.positions.emplace_back(0.0F, 1.0F, 0.0F);
  for (uint32_t i = 1; i < kRings; ++i) {
    for (uint32_t j = 0; j < columns; ++j) {
      const double polar = 3.141592653589793 * i / kRings;
      const double azimuth = 6.283185307179586 * j / columns;
      const double radius = 1.0 + 0.1 * std::sin(9.0 * polar) * std::sin(7.0 * azimuth);
      mesh.positions.emplace_back(
          radius * dvec3(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)));
    }
  }
  mesh.positions.emplace_back(0.0F, -1.0F, 0.0F);
  const auto last = static_cast<uint32_t>(mesh.positions.size()) - 1;
  for (uint32_t j = 0; j < columns; ++j) {
    const uint32_t next = (j + 1) % columns;
    mesh.triangles.emplace_back(0, 1 + next, 1 + j);
    for (uint32_t i = 0; i + 2 < kRings; ++i) {
      const uint32_t row = 1 + i * columns;
      mesh.triangles.emplace_back(row + j, row + next, row + columns + j);
      mesh.triangles.emplace_back(row + next, row + columns + next, row + columns + j);
    }
    mesh.triangles.emplace_back(last, last - columns + j, last - columns + next);
  }
  Scene scene;
  scene.file = "a closed wavy sphere";
  scene.materials.resize(1);
  scene.objects = {{"", std::move(mesh), 0}};
  return scene;
}

/// From inside of that sphere at its edges: each must hit.
RaySet make_edge_rays(const Mesh& mesh) {
  std::mt19937 generator(2);
  RaySet set{"edges", HitQuery::kNearest, {}};
  const vec3 origin(0.1F, 0.05F, -0.07F);
  while (set.rays.size() < size_t{kSide} * kSide) {
    const uvec3& triangle = mesh.triangles[generator() % mesh.triangles.size()];
    const double s = static_cast<double>(generator()) * 0x1p-32;
    const dvec3 target = glm::mix(dvec3(mesh.positions[triangle.x]), dvec3(mesh.positions[triangle.y]), s);
    set.rays.push_back({origin, 0.0F, vec3(target - dvec3(origin)), kInfinity});
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

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

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
    return static_cast<double>(set.rays.size()) / (1e3 * median_of(ms));
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

void measure(const std::string& file, const std::string& output, uint32_t runs) {
  const Scene scene = file.empty() ? make_wavy_sphere() : load_scene(file);
  const gpu::DeviceHandle device = gpu::open_device();
  const Camera camera = scene.cameras.empty() ? frame_scene(scene, 1.0F) : scene.cameras.front();
  const Bounds bounds = bounds_of(scene);
  Caster robust(*device, scene);
  CasterOptions options;
  options.spirv = k_plain_cast_spirv;
  Caster plain(*device, scene, options);

  std::vector<RaySet> sets = {make_camera_rays(camera)};
  std::vector<Hit> hits(sets[0].rays.size());
  robust.cast(sets[0].rays, hits);
  sets.push_back(make_shadow_rays(sets[0], hits, camera, glm::length(bounds.extent())));
  sets.push_back(make_random_rays(bounds));
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
    measure(scene, output, runs);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "promin-robustness: error: {}\n", error.what());
    return 1;
  }
}
