// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// promin-lab instances measures scenes of many instances, and compares them with copies and with Embree.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <memory>

#include "core/rounding.h"
#include "lab/commands.h"
#include "lab/session.h"
#include "measure/embree.h"
#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "measure/random.h"
#include "measure/ray_sets.h"
#include "measure/samples.h"
#include "promin/instances.h"
#include "trace/render/caster_access.h"

namespace promin::lab {
namespace {

/// A mesh, and its number of instances.
struct Sight {
  std::string mesh;
  uint32_t count;
  /// True if a scene with copies of the mesh fits into memory.
  bool has_copies;
};

/// Returns a scene of instances at random places, with random rotations and scales from 0.5 to 1.1. Every seventh is
/// mirrored. The cube that they fill grows with their number.
Scene make_scene(const Sight& sight) {
  const world::Scene one = measure::open_scene(sight.mesh);
  const Mesh* mesh = nullptr;
  for (const world::Object& object : one.objects) {
    if (mesh == nullptr) mesh = std::get_if<Mesh>(&object.shape);
  }
  if (mesh == nullptr) throw InputError({"lab.mesh.missing", "the scene has no mesh", sight.mesh, "use another one"});
  Bounds box;
  for (const vec3& position : mesh->positions) box.extend(position);
  Scene scene;
  scene.file = fmt::format("{} x {}", std::filesystem::path(sight.mesh).stem().string(), sight.count);
  scene.materials.resize(1);
  scene.add("mesh", *mesh).geometry = 0;
  const double side = max_component(box.extent()) * std::cbrt(static_cast<double>(sight.count));
  measure::Random random(1);
  std::vector<dmat4> places;
  for (uint32_t i = 0; i < sight.count; ++i) {
    dmat4 place = glm::mat4_cast(glm::angleAxis(random.uniform(0.0, 6.28), random.direction()));
    const double scale = random.uniform(0.5, 1.1);
    for (int axis = 0; axis < 3; ++axis) place[axis] *= scale;
    if (i % 7 == 6) place[0] = -place[0];
    const dvec3 center(random.uniform(0.0, side), random.uniform(0.0, side), random.uniform(0.0, side));
    place[3] = dvec4(center - dmat3(place) * dvec3(box.center()), 1.0);
    places.push_back(place);
  }
  scene.objects[0].world_from_object = places[0];
  add_instances(scene, 0, std::span(places).subspan(1));
  return scene;
}

/// A scene that promin and Embree have prepared.
struct Prepared {
  world::Scene scene;
  Caster caster;
  std::unique_ptr<measure::EmbreeCaster> embree;

  Prepared(const Session& session, const Scene& source, Instancing instancing)
      : scene(world::flatten(source, world::Purpose::kHits, instancing)),
        caster(make_caster(session.device(), scene)),
        embree(measure::make_embree_caster(scene)) {}
};

/// Adds the figures of a prepared scene: memory, and the times of the builds.
void describe(Prepared& prepared, const std::string& name, Json& row) {
  row[name + "_bytes"] = prepared.caster.setup_stats().device_bytes;
  row[name + "_build_ms"] = prepared.caster.setup_stats().bvh_ms;
  if (!prepared.embree) return;
  row["embree_" + name + "_bytes"] = prepared.embree->size_bytes();
  row["embree_" + name + "_build_ms"] = prepared.embree->time_build();
}

class InstancesBench {
 public:
  explicit InstancesBench(const Session& session) : session_(session) {}

  Json measure(const std::vector<Sight>& sights) {
    for (const Sight& sight : sights) measure(sight);
    return {{"rows", rows_}};
  }

 private:
  void measure(const Sight& sight) {
    const Scene source = make_scene(sight);
    session_.say(fmt::format("instances: {}", source.file.string()));
    Prepared instances(session_, source, Instancing::kAll);
    std::optional<Prepared> copies;
    if (sight.has_copies) copies.emplace(session_, source, Instancing::kNone);
    Json row = {{"mesh", sight.mesh}, {"count", sight.count}};
    row["triangles"] = uint64_t{primitive_count(source, source.objects[0])} * sight.count;
    describe(instances, "instances", row);
    if (copies) describe(*copies, "copies", row);
    const Camera camera = view_of(instances.scene, uvec2(session_.side())).camera;
    const size_t count = size_t{session_.side()} * session_.side();
    for (const measure::RaySet& set : {measure::make_camera_rays(camera, uvec2(session_.side())),
                                       measure::make_random_rays(instances.scene, count)}) {
      time_rays(set, instances, copies ? &*copies : nullptr, row);
    }
    rows_.push_back(std::move(row));
    session_.write("instances", {{"rows", rows_}});
  }

  void time_rays(const measure::RaySet& set, Prepared& instances, Prepared* copies, Json& row) {
    std::vector<Hit> hits(set.rays.size());
    std::vector<std::string> names;
    std::vector<std::function<double()>> contestants;
    const auto add = [&](const std::string& name, Prepared* prepared) {
      if (prepared == nullptr) return;
      names.push_back("promin_" + name);
      contestants.emplace_back([&, prepared] { return prepared->caster.cast(set.rays, hits, set.query); });
      if (!prepared->embree) return;
      names.push_back("embree_" + name);
      contestants.emplace_back(
          [&, prepared] { return prepared->embree->cast(set.rays, hits, set.query, measure::EmbreeCall::kSingle); });
    };
    add("instances", &instances);
    add("copies", copies);
    const std::vector<std::vector<double>> ms = measure::time_in_turns(contestants, session_.runs());
    Json figures = {{"rays", set.rays.size()}};
    for (size_t i = 0; i < names.size(); ++i) figures[names[i] + "_ms"] = ms[i];
    fmt::print("{:<18} {:<7}", fmt::format("{} x {}", row["mesh"].get<std::string>(), row["count"].get<uint32_t>()),
               set.name);
    for (size_t i = 0; i < names.size(); ++i) {
      const double median = measure::quartiles_of(ms[i]).median;
      fmt::print("  {} {:.2f}", names[i], static_cast<double>(set.rays.size()) / (1e3 * median));
    }
    fmt::print("  Mrays/s\n");
    std::fflush(stdout);
    row[set.name] = std::move(figures);
  }

  const Session& session_;
  Json rows_ = Json::array();
};

void measure_instances(const LabOptions& options, const std::string& mesh, bool is_quick) {
  std::vector<Sight> sights = {{mesh, 10, true}, {mesh, 100, true}, {"wavy:320", 10'000, true}};
  // These rows show how memory and time grow. A larger mesh would have too many primitives for the numbers of hits.
  for (const uint32_t count : {10U, 1000U, 100'000U}) sights.push_back({"wavy:40000", count, false});
  if (is_quick) sights = {{"wavy:2000", 10, true}, {"wavy:2000", 1000, false}};
  const Session session(options);
  session.write("instances", InstancesBench(session).measure(sights));
}

}  // namespace

app::Command add_instances_command(CLI::App& program) {
  CLI::App& command =
      app::add_command(program, "instances",
                       "Measures rates, memory and builds of many instances, and compares them with copies and Embree");
  const auto options = std::make_shared<LabOptions>();
  options->runs = 5;
  options->side = 512;
  const auto mesh = std::make_shared<std::string>("wavy:70000");
  const auto is_quick = std::make_shared<bool>(false);
  app::OptionTable table(command);
  add_measuring_options(table, *options, 1);
  table.add("--mesh", "SCENE",
            fmt::format("Mesh of the first scenes: the first one of a scene file, or wavy:N [{}]", *mesh),
            [=](const app::OptionValues& words) { *mesh = words.text(); });
  table.add_flag("--quick", "Use small scenes, only to check that the command works", *is_quick);
  return {&command, [options, mesh, is_quick] { measure_instances(*options, *mesh, *is_quick); }};
}

}  // namespace promin::lab
