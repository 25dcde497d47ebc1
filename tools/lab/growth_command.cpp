// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// promin-lab growth measures how time, steps and memory grow with the number of triangles.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <deque>
#include <memory>

#include "device_scene/pack_scene.h"
#include "lab/commands.h"
#include "lab/session.h"
#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "measure/step_counts.h"
#include "trace/render/caster_access.h"

namespace promin::lab {
namespace {

class GrowthBench {
 public:
  GrowthBench(const Session& session, const std::vector<uint32_t>& sizes) : session_(session), sizes_(sizes) {}

  Json run() {
    measure_triangles();
    return {{"rows", rows_}};
  }

 private:
  /// A mesh of the wavy sphere, with the measurements of it.
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
    return {{"curve", curve}, {"value", size.triangle_count()}};
  }

  /// The meshes of all sizes stay on the device, so that each turn measures all of them.
  void measure_triangles() {
    std::deque<Size> sizes;
    for (const uint32_t wanted : sizes_) {
      session_.say(fmt::format("growth: {} triangles", wanted));
      sizes.emplace_back(session_, wanted);
    }
    session_.say("growth: all sizes in turns");
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
    const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, session_.runs());
    for (size_t s = 0; s < sizes.size(); ++s) {
      Json row = row_of(sizes[s], "build");
      row["build_ms"] = ms[s];
      row["device_bytes"] = sizes[s].caster.setup_stats().device_bytes;
      rows_.push_back(std::move(row));
    }
  }

  const Session& session_;
  const std::vector<uint32_t>& sizes_;
  Json rows_ = Json::array();
};

void measure_growth(const LabOptions& options, bool is_quick) {
  const std::vector<uint32_t> sizes =
      is_quick ? std::vector<uint32_t>{2'000, 8'000, 32'000}
               : std::vector<uint32_t>{10'000, 30'000, 100'000, 300'000, 1'000'000, 3'000'000, 5'000'000};
  const Session session(options);
  session.write("growth", GrowthBench(session, sizes).run());
}

}  // namespace

app::Command add_growth_command(CLI::App& program) {
  CLI::App& command = app::add_command(
      program, "growth", "Measures how steps, time and memory grow with the number of triangles of a wavy sphere");
  const auto options = std::make_shared<LabOptions>();
  options->runs = 3;
  options->side = 512;
  const auto is_quick = std::make_shared<bool>(false);
  app::OptionTable table(command);
  add_measuring_options(table, *options, 1);
  table.add_flag("--quick", "Use small meshes, only to check that the command works", *is_quick);
  return {&command, [options, is_quick] { measure_growth(*options, *is_quick); }};
}

}  // namespace promin::lab
