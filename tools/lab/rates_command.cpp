// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <memory>
#include <thread>

#include "bvh/builder.h"
#include "lab/commands.h"
#include "lab/rates.h"
#include "measure/embree.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "promin/error.h"

namespace promin::lab {
namespace {

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

/// Returns the rate of the row's rays in millions per second, from the median of these times.
std::string rate_of(const Json& row, const char* key) {
  if (!row.contains(key)) return "-";
  return fmt::format("{:.2f}", row["count"].get<double>() / (1e3 * quartiles_of(row, key).median));
}

void print_rays(const Json& row) {
  std::string quartiles = "-";
  std::string ratio = "-";
  std::string differing = "-";
  if (row.contains("time_ratio")) {
    // Returns the ratio of rates, which is the inverse of the ratio of times.
    const measure::Quartiles q = quartiles_of(row, "time_ratio");
    ratio = fmt::format("{:.3f}", 1.0 / q.median);
    quartiles = fmt::format("{:.3f}-{:.3f}", 1.0 / q.upper, 1.0 / q.lower);
    differing = std::to_string(row["differing_hits"].get<uint64_t>());
  }
  fmt::print("  {:<7}{:>9}{:>8}{:>9}{:>9}{:>9}{:>15}{:>9}{:>8.2f}{:>8.2f}\n", row["rays"].get<std::string>(),
             row["count"].get<uint64_t>(), rate_of(row, "promin_ms"), rate_of(row, "peer_ms"),
             rate_of(row, "peer_packets_ms"), ratio, quartiles, differing, row["node_steps_per_ray"].get<double>(),
             row["primitive_tests_per_ray"].get<double>());
}

void print_picture(const Json& row) {
  fmt::print("  {}, {} x {}, {} bounces: {:.1f} ms, {:.2f} of what its own {:.2f} Mrays take by cast",
             row["what"].get<std::string>(), row["width"].get<uint32_t>(), row["height"].get<uint32_t>(),
             row["depth"].get<uint32_t>(), quartiles_of(row, "promin_ms").median,
             quartiles_of(row, "rays_time_ratio").median, 1e-6 * row["count"].get<double>());
  if (row.contains("time_ratio")) {
    fmt::print(", {:.2f} of what Embree takes for them", quartiles_of(row, "time_ratio").median);
  }
  fmt::print("\n");
}

void print_picture_rays(const Json& row) {
  fmt::print("  {:<10}{:>9}{:>8}{:>9}\n", row["rays"].get<std::string>(), row["count"].get<uint64_t>(),
             rate_of(row, "promin_ms"), rate_of(row, "peer_ms"));
}

void print_rates(const std::string& scene, const Json& rates) {
  print_build(scene, rates["builds"][0]);
  fmt::print("  {:<7}{:>9}{:>8}{:>9}{:>9}{:>9}{:>15}{:>9}{:>8}{:>8}\n", "rays", "count", "promin", "Embree", "packets",
             "ratio", "quartiles", "differ", "steps", "tests");
  for (const Json& row : rates["rows"]) print_rays(row);
  for (const Json& row : rates.value("pictures", Json::array())) print_picture(row);
  for (const Json& row : rates.value("picture_rays", Json::array())) print_picture_rays(row);
  std::fflush(stdout);
}

void check_options(const LabOptions& options) {
  // The command opens all scenes first, so that an error in one is found before the long work begins.
  for (const std::string& scene : options.scenes) measure::open_scene(scene);
  if (!options.rays) return;
  if (options.runs == 0U) {
    throw UsageError(
        {"usage.option.needs", "--rays goes with pictures, which --runs 0 leaves out", "", "give some runs"});
  }
  if (!std::filesystem::is_directory(*options.rays)) {
    throw RunError({"folder.missing", "the folder does not exist", options.rays->string(), "create it first"});
  }
}

void measure_rates(const LabOptions& options) {
  check_options(options);
  const Session session(options);
  const std::string embree = measure::embree_version();
  fmt::print("{}\n{}; {} threads; {} runs in turns; Mrays/s; ratio = promin's rate / Embree's\n",
             gpu::info_of(session.device()).driver, embree.empty() ? "no Embree" : embree,
             std::thread::hardware_concurrency(), session.runs());
  Json all = {{"rows", Json::array()}, {"builds", Json::array()}, {"pictures", Json::array()}};
  all["picture_rays"] = Json::array();
  for (const std::string& scene : options.scenes) {
    Json rates = Json::object();
    add_rates(session, measure::open_scene(scene), rates);
    print_rates(std::filesystem::path(scene).filename().string(), rates);
    for (auto& [table, rows] : rates.items()) {
      for (const Json& row : rows) all[table].push_back(row);
    }
    session.write("rates", all);
  }
}

}  // namespace

app::Command add_rates_command(CLI::App& program) {
  CLI::App& command = app::add_command(
      program, "rates", "Measures rates of rays, tree builds and pictures, and compares them with Embree");
  const auto options = std::make_shared<LabOptions>();
  app::OptionTable table(command);
  add_scenes(command, table, *options);
  // With 0 runs the command only counts steps.
  add_measuring_options(table, *options, 0);
  table.add("--builder", "NAME", fmt::format("{} [sah]", fmt::join(builder_names(), ", ")),
            [=](const app::OptionValues& words) { options->builder = words.choice(builder_names()); });
  table.add("--max-depth", "N", fmt::format("Largest number of mirror bounces in the picture [{}]", View().max_depth),
            [=](const app::OptionValues& words) { options->max_depth = words.whole(0, 0, kMaxDepth); });
  table.add(
      "--rays", "FOLDER",
      "Folder to write rays to, with one .npy file per set of rays: those of the rows as SCENE_rates_SET, those of the "
      "picture as SCENE_SET, and the triangles as SCENE_triangles",
      [=](const app::OptionValues& words) { options->rays = words.text(); });
  return {&command, [options] { measure_rates(*options); }};
}

}  // namespace promin::lab
