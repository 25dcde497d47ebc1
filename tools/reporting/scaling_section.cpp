// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// How time, steps and memory grow with triangles, pixels, sources and depth.
#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <map>

#include "device_scene/pack_scene.h"
#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "measure/step_counts.h"
#include "promin/renderer.h"
#include "render/caster_access.h"
#include "render/renderer_impl.h"
#include "reporting/scene_hash.h"
#include "reporting/session.h"

namespace promin::report {
namespace {

class ScalingBench {
 public:
  explicit ScalingBench(const Session& session) : session_(session) {}

  Json run() {
    measure_triangles();
    measure_pixels();
    measure_sources();
    measure_depth();
    return {{"rows", rows_}};
  }

 private:
  /// A mesh of the wavy sphere with what is measured of it.
  struct Size {
    uint32_t wanted;
    world::Scene scene;
    Caster caster;
    std::vector<measure::RaySet> sets;
    std::vector<std::vector<Hit>> hits;
    std::vector<measure::StepCounts> steps;

    Size(const Session& session, uint32_t wanted_triangles)
        : wanted(wanted_triangles),
          scene(measure::open_scene(fmt::format("wavy:{}", wanted))),
          caster(make_caster(session.device(), scene)) {
      const uint32_t side = session.side();
      sets = measure::make_ray_sets(caster, scene, view_of(scene, uvec2(side)).camera, side, false);
      const measure::StepCounter counter(session.device(), scene, "sah");
      for (const measure::RaySet& set : sets) {
        hits.emplace_back(set.rays.size());
        steps.push_back(counter.count(set));
      }
    }

    double triangle_count() const {
      return static_cast<double>(std::get<Mesh>(scene.objects[0].shape).triangles.size());
    }
  };

  Json row_of(const Size& size, const std::string& curve) const {
    return {{"id", fmt::format("triangles/{}/{}", curve, size.wanted)},
            {"variable", "triangles"},
            {"scene", session_.name_of(size.scene)},
            {"scene_hash", hash_of(size.scene)},
            {"curve", curve},
            {"value", size.triangle_count()}};
  }

  /// All sizes stay on the device, so that each turn has them all.
  void measure_triangles() {
    std::deque<Size> sizes;
    for (const uint32_t wanted : session_.pick<std::vector<uint32_t>>(
             {10'000, 30'000, 100'000, 300'000, 1'000'000, 3'000'000, 5'000'000}, {2'000, 8'000, 32'000})) {
      session_.say(fmt::format("scaling: {} triangles", wanted));
      sizes.emplace_back(session_, wanted);
    }
    session_.say("scaling: all sizes in turns");
    measure_rays(sizes);
    measure_builds(sizes);
  }

  void measure_rays(std::deque<Size>& sizes) {
    const size_t set_count = sizes.front().sets.size();
    std::vector<std::function<double()>> contestants;
    for (Size& size : sizes) {
      for (size_t i = 0; i < set_count; ++i) {
        contestants.emplace_back(
            [&size, i] { return size.caster.cast(size.sets[i].rays, size.hits[i], size.sets[i].query); });
      }
    }
    std::vector<std::vector<double>> ns = measure::time_in_turns(contestants, session_.runs());
    for (size_t i = 0; i < set_count; ++i) {
      const std::string& name = sizes.front().sets[i].name;
      for (size_t s = 0; s < sizes.size(); ++s) {
        const Size& size = sizes[s];
        const auto rays = static_cast<double>(size.sets[i].rays.size());
        std::vector<double>& of_size = ns[s * set_count + i];
        for (double& time : of_size) time *= 1e6 / rays;
        Json row = row_of(size, name);
        row["ns_per_ray"] = of_size;
        row["time_ratio"] = measure::ratios_of(of_size, ns[i]);
        row["node_steps_per_ray"] = static_cast<double>(size.steps[i].node_steps) / rays;
        row["primitive_tests_per_ray"] = static_cast<double>(size.steps[i].primitive_tests) / rays;
        rows_.push_back(std::move(row));
      }
    }
  }

  void measure_builds(const std::deque<Size>& sizes) {
    std::vector<std::function<double()>> contestants;
    for (const Size& size : sizes) contestants.emplace_back([&] { return pack_scene(size.scene, "sah").bvh_ms; });
    const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, session_.few_runs());
    for (size_t s = 0; s < sizes.size(); ++s) {
      Json row = row_of(sizes[s], "build");
      row["build_ms"] = json_of_few(ms[s]);
      row["device_bytes"] = sizes[s].caster.setup_stats().device_bytes;
      rows_.push_back(std::move(row));
    }
  }

  struct Frame {
    double value = 0.0;
    const world::Scene* scene = nullptr;
    View view;
  };

  /// Pictures that differ in one variable, in turns.
  void measure_frames(const std::string& variable, const std::vector<Frame>& frames) {
    session_.say("scaling: " + variable);
    std::map<const world::Scene*, Renderer> renderers;
    std::map<const world::Scene*, std::string> hashes;
    std::vector<std::function<double()>> contestants;
    std::vector<RayCounts> counts(frames.size());
    for (size_t i = 0; i < frames.size(); ++i) {
      const world::Scene* scene = frames[i].scene;
      Renderer& renderer = renderers.try_emplace(scene, make_renderer(session_.device(), *scene)).first->second;
      hashes[scene] = hash_of(*scene);
      contestants.emplace_back([&, i] {
        const RenderResult result = renderer.render(frames[i].view);
        counts[i] = result.rays;
        return result.trace_ms;
      });
    }
    const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, session_.runs());
    for (size_t i = 0; i < frames.size(); ++i) {
      rows_.push_back({{"id", fmt::format("{}/{:g}", variable, frames[i].value)},
                       {"variable", variable},
                       {"scene", session_.name_of(*frames[i].scene)},
                       {"scene_hash", hashes[frames[i].scene]},
                       {"curve", "picture"},
                       {"value", frames[i].value},
                       {"ms", ms[i]},
                       {"time_ratio", measure::ratios_of(ms[i], ms[0])},
                       {"rays", counts[i].total()}});
    }
  }

  world::Scene load(const char* own) const { return session_.load_scenes({own}).front(); }

  void measure_pixels() {
    const world::Scene scene = load("all_primitives.gltf");
    std::vector<Frame> frames;
    for (const uint32_t side : session_.pick<std::vector<uint32_t>>({64, 128, 256, 512, 1024}, {32, 64, 128})) {
      frames.push_back({static_cast<double>(side) * side, &scene, view_of(scene, uvec2(side))});
    }
    measure_frames("pixels", frames);
  }

  /// The scene's first source, as many times side by side: each casts its own shadows.
  void measure_sources() {
    const world::Scene scene = load("all_primitives.gltf");
    const float size = glm::length(bounds_of(scene).extent());
    const std::vector<uint32_t> numbers = session_.pick<std::vector<uint32_t>>({1, 2, 4, 8, 16}, {1, 2, 4});
    std::vector<world::Scene> scenes;
    std::vector<Frame> frames;
    for (const uint32_t count : numbers) {
      world::Scene& lit = scenes.emplace_back(scene);
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
    const world::Scene scene = load("mirrors.gltf");
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
};

}  // namespace

Json measure_scaling(const Session& session) {
  return ScalingBench(session).run();
}

}  // namespace promin::report
