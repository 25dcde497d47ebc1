// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// promin-bench: rates of promin and, where it is built with it, of Embree over the same rays, run in turns.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "core/file.h"
#include "core/stopwatch.h"
#include "device_scene/pack_scene.h"
#include "measure/embree.h"
#include "measure/meshes.h"
#include "measure/ray_sets.h"
#include "measure/samples.h"
#include "measure/step_counts.h"
#include "promin/caster.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "view_setup.h"

namespace {

using namespace promin;
using namespace promin::measure;
using Json = nlohmann::ordered_json;

struct BenchOptions {
  std::vector<std::string> scenes;
  std::optional<std::string> device;
  std::string builder = "sah";
  std::string output;
  uint32_t side = 1024;
  uint32_t runs = 9;
};

/// A file, or "wavy:N" and "needles:N" for a generated mesh of about N triangles.
Scene open_scene(const std::string& word) {
  const size_t colon = word.find(':');
  const std::string kind = word.substr(0, colon);
  if (colon == std::string::npos || (kind != "wavy" && kind != "needles")) return load_scene(word);
  uint32_t count = 0;
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data() + colon + 1, end, count);
  if (error != std::errc() || rest != end || count < 16 || count > 50'000'000) {
    throw UsageError({"no number of triangles from 16 to 50000000", word, "write " + kind + ":100000"});
  }
  Scene scene = kind == "wavy" ? make_wavy_sphere(count) : make_needles(count);
  scene.file = word;
  return scene;
}

Json json_of(const Quartiles& q) {
  return {{"median", q.median}, {"lower_quartile", q.lower}, {"upper_quartile", q.upper}};
}

std::vector<double> divide(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return ratios;
}

double mrays_per_s(size_t count, double ms) {
  return static_cast<double>(count) / (1e3 * ms);
}

/// Rays with a hit by one and none by the other.
uint64_t count_differences(std::span<const Hit> a, std::span<const Hit> b) {
  uint64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += std::isfinite(a[i].t) != std::isfinite(b[i].t) ? 1 : 0;
  return count;
}

/// One scene on one device.
class Bench {
 public:
  Bench(const gpu::Device& device, const Scene& scene, const BenchOptions& options)
      : device_(device), scene_(scene), options_(options) {
    app::ViewOptions view;
    view.size = uvec2(options.side);
    camera_ = app::make_view(scene, view, app::Console(app::Verbosity::kQuiet)).camera;
  }

  Json run() {
    CasterOptions caster_options;
    caster_options.builder = options_.builder;
    Caster caster(device_, scene_, caster_options);
    const SetupStats& setup = caster.setup_stats();
    uint64_t primitives = 0;
    for (const Object& object : scene_.objects) primitives += primitive_count(object.shape);
    Json json = {
        {"scene", scene_.file.filename().string()},
        {"primitives", primitives},
        {"builder", options_.builder},
        {"nodes", setup.bvh.nodes},
        {"depth", setup.bvh.depth},
        {"sah_cost", setup.bvh.sah_cost},
        {"device_bytes_per_primitive", static_cast<double>(setup.device_bytes) / static_cast<double>(primitives)}};
    fmt::print("{}, {} primitives, {:.1f} bytes a primitive, builder {}\n", scene_.file.filename().string(), primitives,
               json["device_bytes_per_primitive"].get<double>(), options_.builder);

    const std::unique_ptr<EmbreeCaster> embree = options_.runs > 0 ? make_embree_caster(scene_) : nullptr;
    if (options_.runs > 0) json["build"] = measure_build(embree.get());
    const StepCounter counter(device_, scene_, options_.builder);
    fmt::print("  {:<7}{:>9}{:>8}{:>9}{:>9}{:>9}{:>15}{:>9}{:>8}{:>8}\n", "rays", "count", "promin", "Embree",
               "packets", "ratio", "quartiles", "differ", "steps", "tests");
    for (const RaySet& set : make_sets(caster)) {
      Json entry = count_steps(counter, set);
      if (options_.runs > 0) entry.update(measure_rates(caster, embree.get(), set));
      print(entry);
      json["sets"].push_back(std::move(entry));
    }
    return json;
  }

 private:
  std::vector<RaySet> make_sets(Caster& caster) const {
    std::vector<RaySet> sets = {make_camera_rays(camera_, options_.side)};
    std::vector<Hit> hits(sets[0].rays.size());
    caster.cast(sets[0].rays, hits);
    sets.push_back(make_shadow_rays(sets[0], hits, scene_, camera_));
    sets.push_back(make_random_rays(scene_, hits.size()));
    return sets;
  }

  /// From triangles in memory to all that is copied to the device, and the builder's part of it.
  Json measure_build(EmbreeCaster* embree) const {
    std::vector<double> all_ms;
    std::vector<double> bvh_ms;
    std::vector<double> embree_ms;
    for (uint32_t i = 0; i <= options_.runs; ++i) {
      const Stopwatch packing;
      const PackedScene packed = pack_scene(scene_, options_.builder);
      const double ms = packing.ms();
      const double peer_ms = embree != nullptr ? embree->time_build() : 0.0;
      if (i == 0) continue;  // warm-up
      all_ms.push_back(ms);
      bvh_ms.push_back(packed.bvh_ms);
      if (embree != nullptr) embree_ms.push_back(peer_ms);
    }
    Json json = {{"promin_ms", json_of(quartiles_of(all_ms))}, {"promin_bvh_ms", json_of(quartiles_of(bvh_ms))}};
    fmt::print("  build: promin {:.1f} ms ({:.1f} of it the BVH)", quartiles_of(all_ms).median,
               quartiles_of(bvh_ms).median);
    if (embree != nullptr) {
      const Quartiles ratio = quartiles_of(divide(all_ms, embree_ms));
      const Quartiles bvh_ratio = quartiles_of(divide(bvh_ms, embree_ms));
      json["embree_ms"] = json_of(quartiles_of(embree_ms));
      json["time_ratio"] = json_of(ratio);
      json["bvh_time_ratio"] = json_of(bvh_ratio);
      fmt::print(", Embree {:.1f} ms: time ratio {:.2f} ({:.2f})", quartiles_of(embree_ms).median, ratio.median,
                 bvh_ratio.median);
    }
    fmt::print("\n");
    return json;
  }

  static Json count_steps(const StepCounter& counter, const RaySet& set) {
    const StepCounts counts = counter.count(set);
    const auto rays = static_cast<double>(std::max<uint64_t>(1, counts.rays));
    return {{"rays", set.name},
            {"count", counts.rays},
            {"hits", counts.hits},
            {"node_steps_per_ray", static_cast<double>(counts.node_steps) / rays},
            {"primitive_tests_per_ray", static_cast<double>(counts.primitive_tests) / rays}};
  }

  Json measure_rates(Caster& caster, EmbreeCaster* embree, const RaySet& set) const {
    const size_t count = set.rays.size();
    if (count == 0) return Json::object();
    std::vector<Hit> hits(count);
    std::vector<Hit> single_hits(count);
    std::vector<Hit> packet_hits(count);
    std::vector<double> promin_ms;
    std::vector<double> single_ms;
    std::vector<double> packet_ms;
    for (uint32_t i = 0; i <= options_.runs; ++i) {
      const double ms = caster.cast(set.rays, hits, set.query);
      if (i > 0) promin_ms.push_back(ms);
      if (embree == nullptr) continue;
      const double single = embree->cast(set.rays, single_hits, set.query, EmbreeCall::kSingle);
      const double packets = embree->cast(set.rays, packet_hits, set.query, EmbreeCall::kPackets);
      if (i == 0) continue;  // warm-up
      single_ms.push_back(single);
      packet_ms.push_back(packets);
    }
    Json json = {{"promin_ms", json_of(quartiles_of(promin_ms))},
                 {"promin_mrays_per_s", mrays_per_s(count, quartiles_of(promin_ms).median)}};
    if (embree == nullptr) return json;
    json["embree_ms"] = json_of(quartiles_of(single_ms));
    json["embree_mrays_per_s"] = mrays_per_s(count, quartiles_of(single_ms).median);
    json["embree_packets_ms"] = json_of(quartiles_of(packet_ms));
    json["embree_packets_mrays_per_s"] = mrays_per_s(count, quartiles_of(packet_ms).median);
    json["rate_ratio"] = json_of(quartiles_of(divide(single_ms, promin_ms)));
    json["packets_rate_ratio"] = json_of(quartiles_of(divide(packet_ms, promin_ms)));
    json["differing_hits"] = count_differences(hits, single_hits);
    return json;
  }

  static void print(const Json& set) {
    const auto number = [&](const char* key, int digits) {
      return set.contains(key) ? fmt::format("{:.{}f}", set[key].get<double>(), digits) : std::string("-");
    };
    std::string quartiles = "-";
    std::string ratio = "-";
    if (set.contains("rate_ratio")) {
      const Json& q = set["rate_ratio"];
      ratio = fmt::format("{:.3f}", q["median"].get<double>());
      quartiles = fmt::format("{:.3f}-{:.3f}", q["lower_quartile"].get<double>(), q["upper_quartile"].get<double>());
    }
    fmt::print("  {:<7}{:>9}{:>8}{:>9}{:>9}{:>9}{:>15}{:>9}{:>8}{:>8}\n", set["rays"].get<std::string>(),
               set["count"].get<uint64_t>(), number("promin_mrays_per_s", 2), number("embree_mrays_per_s", 2),
               number("embree_packets_mrays_per_s", 2), ratio, quartiles, number("differing_hits", 0),
               number("node_steps_per_ray", 2), number("primitive_tests_per_ray", 2));
    std::fflush(stdout);
  }

  const gpu::Device& device_;
  const Scene& scene_;
  const BenchOptions& options_;
  Camera camera_;
};

void measure_all(const BenchOptions& options) {
  const gpu::DeviceHandle device = gpu::open_device(options.device);
  const gpu::DeviceInfo& info = gpu::info_of(*device);
  const std::string embree = embree_version();
  const unsigned threads = std::thread::hardware_concurrency();
  Json json = {{"device", info.name}, {"device_type", info.type}, {"driver", info.driver},
               {"threads", threads},  {"runs", options.runs},     {"side", options.side}};
  json["embree"] = embree.empty() ? Json() : Json(embree);
  fmt::print("{}\n{}; {} threads; {} runs in turns; Mrays/s; ratio = promin's rate / Embree's\n", info.driver,
             embree.empty() ? "no Embree" : embree, threads, options.runs);
  for (const std::string& word : options.scenes) {
    const Scene scene = open_scene(word);
    json["scenes"].push_back(Bench(*device, scene, options).run());
    if (!options.output.empty()) write_text_file(options.output, json.dump(1) + "\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Rates of promin beside Embree's over the same rays: camera, shadow and random.", "promin-bench");
  BenchOptions options;
  program.add_option("SCENE", options.scenes, "Scene files, or wavy:N or needles:N for a mesh of about N triangles")
      ->required();
  program.add_option("--device", options.device, "As `promin render` takes it");
  program.add_option("--builder", options.builder, fmt::format("{} [sah]", fmt::join(builder_names(), ", ")));
  program.add_option("--runs", options.runs, "Runs of each after a warm-up [9]; 0 only counts steps")
      ->check(CLI::Range(0, 1000));
  program.add_option("--side", options.side, "Pixels of the camera's picture each way [1024]")
      ->check(CLI::Range(1, 4096));
  program.add_option("-o,--output", options.output, "Write the figures as JSON");
  CLI11_PARSE(program, argc, argv);
  try {
    measure_all(options);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "promin-bench: error: {}\n", error.what());
    return 1;
  }
}
