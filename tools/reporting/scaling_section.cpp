// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// How time, steps and memory grow with triangles, pixels, sources and depth.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "measure/step_counts.h"
#include "render/renderer.h"
#include "reporting/fit.h"
#include "reporting/provenance.h"

namespace promin::report {
namespace {

/// Points of one curve, for its exponent.
struct Curve {
  std::vector<double> xs;
  std::vector<double> ys;

  void add(double x, double y) {
    if (x <= 0.0 || y <= 0.0) return;
    xs.push_back(x);
    ys.push_back(y);
  }
};

class ScalingBench {
 public:
  explicit ScalingBench(const Session& session) : session_(session) {}

  Json run() {
    measure_triangles();
    measure_pixels();
    measure_sources();
    measure_depth();
    return {{"rows", rows_}, {"fits", fits_}};
  }

 private:
  void fit(const std::string& id, const Curve& curve) {
    if (curve.xs.size() < 3) return;
    const PowerFit fit = fit_power(curve.xs, curve.ys);
    fits_.push_back({{"id", id},
                     {"exponent", fit.exponent},
                     {"lower", fit.lower},
                     {"upper", fit.upper},
                     {"points", curve.xs.size()}});
  }

  void measure_triangles() {
    std::map<std::string, Curve> times;
    std::map<std::string, Curve> steps;
    Curve builds;
    Curve bytes;
    for (const uint32_t wanted : session_.pick<std::vector<uint32_t>>(
             {10'000, 30'000, 100'000, 300'000, 1'000'000, 3'000'000, 5'000'000}, {2'000, 8'000, 32'000})) {
      session_.say(fmt::format("scaling: {} triangles", wanted));
      Scene scene = measure::make_wavy_sphere(wanted);
      scene.file = fmt::format("wavy:{}", wanted);
      const auto count = static_cast<double>(std::get<Mesh>(scene.objects[0].shape).triangles.size());
      const std::string hash = hash_of(std::get<Mesh>(scene.objects[0].shape));
      Caster caster(session_.device(), scene);
      const uint32_t side = session_.pick(512U, 96U);
      const std::vector<measure::RaySet> sets =
          measure::make_ray_sets(caster, scene, view_of(scene, uvec2(side)).camera, side, false);
      std::vector<std::vector<Hit>> hits;
      for (const measure::RaySet& set : sets) hits.emplace_back(set.rays.size());
      std::vector<std::function<double()>> contestants;
      for (size_t i = 0; i < sets.size(); ++i) {
        contestants.emplace_back([&, i] { return caster.cast(sets[i].rays, hits[i], sets[i].query); });
      }
      const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, session_.runs());
      const measure::StepCounter counter(session_.device(), scene, "sah");
      for (size_t i = 0; i < sets.size(); ++i) {
        const measure::StepCounts counts = counter.count(sets[i]);
        const auto rays = static_cast<double>(sets[i].rays.size());
        const Json ns = json_of_times(ms[i], 1e6 / rays);
        const double node_steps = static_cast<double>(counts.node_steps) / rays;
        rows_.push_back({{"id", fmt::format("triangles/{}/{}", sets[i].name, wanted)},
                         {"variable", "triangles"},
                         {"scene", name_of(scene)},
                         {"scene_hash", hash},
                         {"curve", sets[i].name},
                         {"value", count},
                         {"ns_per_ray", ns},
                         {"node_steps_per_ray", node_steps},
                         {"primitive_tests_per_ray", static_cast<double>(counts.primitive_tests) / rays}});
        times[sets[i].name].add(count, ns["median"].get<double>());
        steps[sets[i].name].add(count, node_steps);
      }
      const SetupStats& setup = caster.setup_stats();
      rows_.push_back({{"id", fmt::format("triangles/build/{}", wanted)},
                       {"variable", "triangles"},
                       {"scene", name_of(scene)},
                       {"scene_hash", hash},
                       {"curve", "build"},
                       {"value", count},
                       {"build_ms_once", setup.bvh_ms},
                       {"device_bytes", setup.device_bytes}});
      builds.add(count, setup.bvh_ms);
      bytes.add(count, static_cast<double>(setup.device_bytes));
    }
    for (const auto& [name, curve] : times) fit("triangles/" + name + "/ns_per_ray", curve);
    for (const auto& [name, curve] : steps) fit("triangles/" + name + "/node_steps_per_ray", curve);
    fit("triangles/build/build_ms_once", builds);
    fit("triangles/build/device_bytes", bytes);
  }

  struct Frame {
    double value = 0.0;
    const Scene* scene = nullptr;
    View view;
  };

  /// Pictures that differ in one variable, in turns.
  void measure_frames(const std::string& variable, const std::vector<Frame>& frames) {
    session_.say("scaling: " + variable);
    std::map<const Scene*, Renderer> renderers;
    std::map<const Scene*, std::string> hashes;
    std::vector<std::function<double()>> contestants;
    std::vector<RayCounts> counts(frames.size());
    for (size_t i = 0; i < frames.size(); ++i) {
      const Scene* scene = frames[i].scene;
      Renderer& renderer = renderers.try_emplace(scene, session_.device(), *scene).first->second;
      hashes[scene] = hash_of(pack_scene(*scene, "sah"));
      contestants.emplace_back([&, i] {
        const RenderResult result = renderer.render(frames[i].view);
        counts[i] = result.rays;
        return result.trace_ms;
      });
    }
    const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, session_.runs());
    Curve curve;
    for (size_t i = 0; i < frames.size(); ++i) {
      const Json times = json_of_times(ms[i]);
      rows_.push_back({{"id", fmt::format("{}/{:g}", variable, frames[i].value)},
                       {"variable", variable},
                       {"scene", name_of(*frames[i].scene)},
                       {"scene_hash", hashes[frames[i].scene]},
                       {"curve", "picture"},
                       {"value", frames[i].value},
                       {"ms", times},
                       {"rays", counts[i].total()}});
      curve.add(frames[i].value, times["median"].get<double>());
    }
    fit(variable + "/ms", curve);
  }

  Scene load(const char* own) const { return session_.load_scenes({own}).front(); }

  void measure_pixels() {
    const Scene scene = load("all_primitives.gltf");
    std::vector<Frame> frames;
    for (const uint32_t side : session_.pick<std::vector<uint32_t>>({64, 128, 256, 512, 1024}, {32, 64, 128})) {
      frames.push_back({static_cast<double>(side) * side, &scene, view_of(scene, uvec2(side))});
    }
    measure_frames("pixels", frames);
  }

  /// The scene's first source, as many times side by side: each casts its own shadows.
  void measure_sources() {
    const Scene scene = load("all_primitives.gltf");
    const float size = glm::length(bounds_of(scene).extent());
    const std::vector<uint32_t> numbers = session_.pick<std::vector<uint32_t>>({1, 2, 4, 8, 16}, {1, 2, 4});
    std::vector<Scene> scenes;
    std::vector<Frame> frames;
    for (const uint32_t count : numbers) {
      Scene& lit = scenes.emplace_back(scene);
      lit.lights.clear();
      for (uint32_t i = 0; i < count; ++i) {
        const double angle = 6.283185307179586 * i / count;
        Light light;
        light.position = bounds_of(scene).center() + size * vec3(std::cos(angle), 1.0, std::sin(angle));
        lit.lights.push_back(light);
      }
    }
    for (size_t i = 0; i < numbers.size(); ++i) {
      frames.push_back(
          {static_cast<double>(numbers[i]), &scenes[i], view_of(scenes[i], session_.pick(uvec2(256), uvec2(96)))});
    }
    measure_frames("sources", frames);
  }

  void measure_depth() {
    const Scene scene = load("mirrors.gltf");
    std::vector<Frame> frames;
    for (const uint32_t depth : session_.pick<std::vector<uint32_t>>({0, 1, 2, 4, 8, 16, 32}, {0, 1, 2, 4})) {
      View view = view_of(scene, session_.pick(uvec2(256), uvec2(96)));
      view.max_depth = depth;
      frames.push_back({static_cast<double>(depth), &scene, view});
    }
    measure_frames("depth", frames);
  }

  const Session& session_;
  Json rows_ = Json::array();
  Json fits_ = Json::array();
};

}  // namespace

Json measure_scaling(const Session& session) {
  return ScalingBench(session).run();
}

}  // namespace promin::report
