// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What robustness costs and brings: promin's kernel against one with the plain methods (tools/plain), the same rays
// through the same tree, run in turns.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "measure/kernel_pair.h"
#include "measure/meshes.h"
#include "promin/caster.h"
#include "promin/device.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "textbook_cast.spv.h"

namespace {

using namespace promin;
using namespace promin::measure;

constexpr uint32_t kSide = 1024;
constexpr uint32_t kSphereTriangles = 131000;

/// Lost and invented by the plain kernel, as against the robust one; promin-report asks an oracle as well.
nlohmann::ordered_json json_of(const KernelPair& c) {
  return {{"rays", c.rays},
          {"count", c.count},
          {"robust_mrays_per_s", c.robust_mrays_per_s()},
          {"plain_mrays_per_s", c.plain_mrays_per_s()},
          {"lost", c.count_only_robust()},
          {"invented", c.count_only_plain()}};
}

void compare_all(const std::string& file, const std::string& output, uint32_t runs) {
  const Scene scene = file.empty() ? make_wavy_sphere(kSphereTriangles) : load_scene(file);
  const gpu::DeviceHandle device = gpu::open_device();
  const Camera camera = scene.cameras.empty() ? frame_scene(scene, 1.0F) : scene.cameras.front();
  Caster robust(*device, scene);
  CasterOptions options;
  options.spirv = k_textbook_cast_spirv;
  Caster plain(*device, scene, options);

  const std::vector<RaySet> sets = make_ray_sets(robust, scene, camera, kSide, file.empty());

  const gpu::DeviceInfo& info = gpu::info_of(*device);
  nlohmann::ordered_json json = {
      {"scene", scene.file.filename().string()}, {"device", info.name}, {"driver", info.driver}, {"runs", runs}};
  fmt::print("{} on {}, medians of {} runs in turns\n", scene.file.filename().string(), info.driver, runs);
  fmt::print("{:<8}{:>10}{:>16}{:>16}{:>8}{:>8}{:>10}\n", "rays", "count", "robust Mray/s", "plain Mray/s", "ratio",
             "lost", "invented");
  for (const RaySet& set : sets) {
    const KernelPair c = measure_pair(robust, plain, set, runs);
    json["comparisons"].push_back(json_of(c));
    fmt::print("{:<8}{:>10}{:>16.3f}{:>16.3f}{:>8.2f}{:>8}{:>10}\n", c.rays, c.count, c.robust_mrays_per_s(),
               c.plain_mrays_per_s(), c.robust_mrays_per_s() / c.plain_mrays_per_s(), c.count_only_robust(),
               c.count_only_plain());
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
