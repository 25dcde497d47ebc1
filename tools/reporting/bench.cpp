// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// promin-bench: the report's rates of any scenes, as a table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <thread>

#include "bvh/builder.h"
#include "core/file.h"
#include "measure/embree.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "promin/error.h"
#include "reporting/provenance.h"
#include "reporting/session.h"

namespace {

using namespace promin;
using namespace promin::report;

measure::Quartiles quartiles_of(const Json& row, const char* key) {
  return measure::quartiles_of(row.at(key).get<std::vector<double>>());
}

void print_build(const std::string& scene, const Json& build) {
  fmt::print("{}, {} primitives, {:.1f} bytes a primitive, builder {}\n", scene, build["primitives"].get<uint64_t>(),
             build["device_bytes_per_primitive"].get<double>(), build["builder"].get<std::string>());
  if (!build.contains("promin_ms")) return;
  fmt::print("  build: promin {:.1f} ms ({:.1f} of it the BVH)", quartiles_of(build, "promin_ms").median,
             quartiles_of(build, "bvh_ms").median);
  if (build.contains("peer_ms")) {
    fmt::print(", Embree {:.1f} ms: time ratio {:.2f} ({:.2f})", quartiles_of(build, "peer_ms").median,
               quartiles_of(build, "time_ratio").median, quartiles_of(build, "bvh_time_ratio").median);
  }
  fmt::print("\n");
}

void print_rays(const Json& row) {
  const auto rate = [&](const char* key) {
    if (!row.contains(key)) return std::string("-");
    return fmt::format("{:.2f}", row["count"].get<double>() / (1e3 * quartiles_of(row, key).median));
  };
  std::string quartiles = "-";
  std::string ratio = "-";
  std::string differing = "-";
  if (row.contains("time_ratio")) {
    // Of rates, hence the other way round than of times.
    const measure::Quartiles q = quartiles_of(row, "time_ratio");
    ratio = fmt::format("{:.3f}", 1.0 / q.median);
    quartiles = fmt::format("{:.3f}-{:.3f}", 1.0 / q.upper, 1.0 / q.lower);
    differing = std::to_string(row["differing_hits"].get<uint64_t>());
  }
  fmt::print("  {:<7}{:>9}{:>8}{:>9}{:>9}{:>9}{:>15}{:>9}{:>8.2f}{:>8.2f}\n", row["rays"].get<std::string>(),
             row["count"].get<uint64_t>(), rate("promin_ms"), rate("peer_ms"), rate("peer_packets_ms"), ratio,
             quartiles, differing, row["node_steps_per_ray"].get<double>(),
             row["primitive_tests_per_ray"].get<double>());
}

void measure_all(const ReportOptions& options) {
  const Session session(options);
  const std::string embree = measure::embree_version();
  Json json = {{"format", kReportFormat}, {"provenance", describe_run(session)}};
  fmt::print("{}\n{}; {} threads; {} runs in turns; Mrays/s; ratio = promin's rate / Embree's\n",
             json["provenance"]["driver"].get<std::string>(), embree.empty() ? "no Embree" : embree,
             std::thread::hardware_concurrency(), session.runs());
  for (const std::filesystem::path& file : options.scenes) {
    Json rates = Json::object();
    add_rates(session, measure::open_scene(file.string()), rates);
    print_build(file.filename().string(), rates["builds"][0]);
    fmt::print("  {:<7}{:>9}{:>8}{:>9}{:>9}{:>9}{:>15}{:>9}{:>8}{:>8}\n", "rays", "count", "promin", "Embree",
               "packets", "ratio", "quartiles", "differ", "steps", "tests");
    for (const Json& row : rates["rows"]) print_rays(row);
    std::fflush(stdout);
    for (const char* table : {"rows", "builds"}) {
      for (const Json& row : rates[table]) json["rates"][table].push_back(row);
    }
    if (!options.output.empty()) write_text_file(options.output, json.dump() + "\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Rates of promin beside Embree's over the same rays: camera, shadow and random.", "promin-bench");
  ReportOptions options;
  options.runs = 9;
  options.side = 1024;
  std::vector<std::string> scenes;
  program.add_option("SCENE", scenes, "Scene files, or wavy:N or needles:N for a mesh of about N triangles")
      ->required();
  program.add_option("--device", options.device, "As `promin render` takes it");
  program.add_option("--builder", options.builder, fmt::format("{} [sah]", fmt::join(builder_names(), ", ")));
  program.add_option("--runs", *options.runs, "Runs of each after a warm-up [9]; 0 only counts steps")
      ->check(CLI::Range(0, 1000));
  program.add_option("--side", *options.side, "Pixels of the camera's picture each way [1024]")
      ->check(CLI::Range(1, 4096));
  program.add_option("-o,--output", options.output, "Write each run's times and the counts as JSON");
  CLI11_PARSE(program, argc, argv);
  try {
    options.scenes.assign(scenes.begin(), scenes.end());
    measure_all(options);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "promin-bench: error: {}\n", error.what());
    return 1;
  }
}
