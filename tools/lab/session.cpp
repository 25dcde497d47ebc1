// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "lab/session.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <thread>

#include "core/file.h"
#include "device/device.h"
#include "options/tracing_options.h"

namespace promin::lab {
namespace {

/// Returns the name of the CPU and its maker's numbers, because several models often have the same name on virtual
/// machines.
std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  std::map<std::string, std::string> fields;
  // The loop reads only the first core's block of lines.
  for (std::string line; std::getline(file, line) && !line.empty();) {
    const size_t colon = line.find(':');
    if (colon == std::string::npos || colon + 2 > line.size()) continue;
    fields[line.substr(0, line.find_last_not_of(" \t", colon - 1) + 1)] = line.substr(colon + 2);
  }
  if (!fields.contains("model name")) return "unknown";
  if (!fields.contains("cpu family") || !fields.contains("model")) return fields["model name"];
  return fmt::format("{} (family {}, model {}, stepping {})", fields["model name"], fields["cpu family"],
                     fields["model"], fields["stepping"]);
}

std::string compiler_name() {
#ifdef __clang__
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

}  // namespace

void add_scenes(CLI::App& command, app::OptionTable& table, LabOptions& options) {
  table.add_required_repeated(
      "SCENE", "SCENE", "Scene files, or wavy:N or needles:N for a mesh of about N triangles",
      [&](const app::OptionValues& words) { options.scenes.assign(words.all().begin(), words.all().end()); });
  command.get_option("SCENE")->expected(-1);  // accepts one scene or more
}

void add_measuring_options(app::OptionTable& table, LabOptions& options, uint32_t fewest_runs) {
  app::add_device_option(table, options.device);
  table.add("--runs", "N", fmt::format("Number of timed runs of each contestant after a warm-up [{}]", options.runs),
            [&, fewest_runs](const app::OptionValues& words) { options.runs = words.whole(0, fewest_runs, 1000); });
  table.add("--side", "N", fmt::format("Width and height of the camera's picture in pixels [{}]", options.side),
            [&](const app::OptionValues& words) { options.side = words.whole(0, 1, 4096); });
  table.add("--commit", "NAME", "Commit of the sources, which is written to the JSON",
            [&](const app::OptionValues& words) { options.commit = words.text(); });
  table.add("-o,--output", "FILE.json", "Write the time of each run and the counts as JSON",
            [&](const app::OptionValues& words) { options.output = words.text(); });
}

void Session::say(const std::string& text) const {
  std::fputs(fmt::format("promin-lab: {}\n", text).c_str(), stderr);
}

Json Session::provenance() const {
  const gpu::DeviceInfo& info = gpu::info_of(*device_);
  return {{"date", fmt::format("{:%Y-%m-%dT%H:%MZ}", fmt::gmtime(std::time(nullptr)))},
          {"commit", options_.commit},
          {"compiler", compiler_name()},
          {"device", info.name},
          {"device_type", info.type},
          {"driver", info.driver},
          {"times_are", device_->timestamp_period_ns() > 0.0 ? "device timestamps" : "the host's waiting"},
          {"cpu", cpu_model()},
          {"threads", std::thread::hardware_concurrency()},
          {"runs", runs()}};
}

void Session::write(const std::string& section, const Json& content) const {
  if (options_.output.empty()) return;
  const Json json = {{"provenance", provenance()}, {section, content}};
  write_text_file(options_.output, json.dump() + "\n");
}

View view_of(const world::Scene& scene, const uvec2& size) {
  View view;
  view.size = size;
  view.camera = scene.cameras.empty() ? look_from_front(scene, static_cast<float>(size.x) / static_cast<float>(size.y))
                                      : scene.cameras.front();
  return view;
}

}  // namespace promin::lab
