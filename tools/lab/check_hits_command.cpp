// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// promin-lab check-hits compares a device's answers in a scene of any size with the oracle's brute force.
#include <CLI/App.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include "bvh/builder.h"
#include "core/parallel.h"
#include "lab/commands.h"
#include "oracle/verdict.h"
#include "promin/caster.h"
#include "promin/device.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "trace/render/caster_access.h"

namespace promin::lab {
namespace {

/// Returns rays. Half of them start at the camera and go through its square view; half are chords between points of the
/// sphere around the scene.
std::vector<Ray> make_rays(const world::Scene& scene, size_t count) {
  std::mt19937 generator(1);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator()) * 0x1p-32 - 1.0; };
  const Camera camera = scene.cameras.empty() ? look_from_front(scene, 1.0F) : scene.cameras.front();
  const dvec3 look(camera.look);
  const dvec3 up(camera.up);
  const dvec3 right = glm::cross(look, up);
  const double half = std::tan(0.5 * static_cast<double>(camera.yfov));
  const Bounds bounds = bounds_of(scene);
  const dvec3 center(bounds.is_empty() ? camera.eye : bounds.center());
  const double radius = bounds.is_empty() ? 1.0 : 0.5 * glm::length(dvec3(bounds.extent()));
  const auto point = [&] {
    dvec3 v;
    do {
      v = dvec3{uniform(), uniform(), uniform()};
    } while (glm::dot(v, v) > 1.0 || glm::dot(v, v) < 1e-3);
    return center + radius * glm::normalize(v);
  };
  std::vector<Ray> rays(count);
  for (size_t i = 0; i < count; ++i) {
    if (i % 2 == 0) {
      rays[i].origin = camera.eye;
      const double x = half * uniform();
      const double y = half * uniform();
      rays[i].direction = vec3(look + x * right + y * up);
    } else {
      rays[i].origin = vec3(point());
      rays[i].direction = vec3(point() - dvec3(rays[i].origin));
    }
  }
  return rays;
}

/// Compares every answer with the oracle's and prints the result, with the answers that are not within the bounds of
/// docs/accuracy.md. Throws RunError if there are such answers.
void check(const std::string& file, const std::string& builder, size_t count) {
  const world::Scene scene = world::flatten(load_scene(file));
  const std::vector<Ray> rays = make_rays(scene, count);
  std::vector<Hit> hits(count);
  const gpu::DeviceHandle device = gpu::open_device();
  TunedCasterOptions options;
  options.builder = builder;
  make_caster(*device, scene, options).cast(rays, hits);

  std::vector<oracle::Verdict> verdicts(count);
  for_each_index(count, 0, [&](size_t i) {
    const oracle::Ray ray{oracle::Vector(rays[i].origin), oracle::Vector(rays[i].direction), rays[i].tmin,
                          rays[i].tmax};
    verdicts[i] = oracle::judge(scene, ray, {hits[i].t, hits[i].object, hits[i].primitive});
  });
  const gpu::DeviceInfo info = gpu::info_of(*device);
  // K may be twice as large on devices that may not round division and square root correctly.
  const oracle::Real most_k = info.type == "CPU" ? oracle::kB1 : 2 * oracle::kB1;
  size_t hit_count = 0;
  size_t beyond_b1 = 0;
  size_t others = 0;
  size_t unexcused = 0;
  double max_k = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const oracle::Verdict& verdict = verdicts[i];
    hit_count += hits[i].object >= 0 ? 1 : 0;
    max_k = std::max(max_k, static_cast<double>(verdict.t_error));
    if (verdict.t_error > most_k) {
      ++beyond_b1;
      std::printf("ray %zu: object %d primitive %d at t = %.9g, the oracle's at %.9Lg; K of t %.3Lg\n", i,
                  hits[i].object, hits[i].primitive, hits[i].t, verdict.exact.t, verdict.t_error);
    }
    if (verdict.is_same) continue;
    ++others;
    if (verdict.margin > oracle::kB2) ++unexcused;
    std::printf("ray %zu: object %d primitive %d at t = %.9g, the oracle's %d %d at %.9Lg; margin %.3Lg u S\n", i,
                hits[i].object, hits[i].primitive, hits[i].t, verdict.exact.object, verdict.exact.primitive,
                verdict.exact.t, verdict.margin);
  }
  std::printf(
      "%s on %s: %zu rays, %zu hits; K of t at most %.3g, %zu beyond %.0Lf; %zu other answers, %zu of them beyond 2 u "
      "S\n",
      scene.file.filename().c_str(), info.driver.c_str(), count, hit_count, max_k, beyond_b1, most_k, others,
      unexcused);
  if (beyond_b1 + unexcused > 0) {
    throw RunError(
        {"lab.bounds.exceeded", "answers are beyond the bounds of docs/accuracy.md", file, "the rays are named above"});
  }
}

struct CheckOptions {
  std::string scene;
  std::string builder = TunedCasterOptions{}.builder;
  uint32_t ray_count = 10000;
};

}  // namespace

app::Command add_check_hits_command(CLI::App& program) {
  CLI::App& command =
      app::add_command(program, "check-hits", "Compares a device's hits in a scene with brute force in long double");
  const auto options = std::make_shared<CheckOptions>();
  app::OptionTable table(command);
  table.add_required("SCENE", "", "Scene file: .gltf, .glb, .obj, .ply, .stl or .nff",
                     [=](const app::OptionValues& words) { options->scene = words.text(); });
  table.add("--rays", "N", "Number of rays [10000]",
            [=](const app::OptionValues& words) { options->ray_count = words.whole(0, 1, 100000000); });
  table.add("--builder", "NAME", "BVH builder [sah]",
            [=](const app::OptionValues& words) { options->builder = words.choice(builder_names()); });
  return {&command, [options] { check(options->scene, options->builder, options->ray_count); }};
}

}  // namespace promin::lab
