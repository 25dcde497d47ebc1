// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include "core/stopwatch.h"
#include "gpu/device.h"
#include "reporting/scripts.h"

namespace promin::report {
namespace {

const Stopwatch& since_start() {
  static const Stopwatch kStart;
  return kStart;
}

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

/// Processes that wanted a core, over the last minute.
Json load_average() {
  std::array<double, 1> load{};
  return getloadavg(load.data(), 1) == 1 ? Json(load[0]) : Json();
}

std::string compiler_name() {
#ifdef __clang__
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

/// As a user would type it; of the scenes and folders only the names.
std::string command_of(const ReportOptions& options) {
  std::string command = "promin-report";
  if (options.is_quick) command += " --quick";
  if (options.runs) command += fmt::format(" --runs {}", *options.runs);
  if (options.device) command += fmt::format(" --device '{}'", *options.device);
  for (const std::filesystem::path& scene : options.scenes) command += fmt::format(" {}", scene.filename().string());
  return command + fmt::format(" -o {}", options.output.filename().string());
}

/// Whether Vulkan's validation layers watch (engine/gpu/open_device.h), which takes time.
bool is_validated() {
  const char* layers = std::getenv("PROMIN_VALIDATION");
  return layers != nullptr && *layers != '\0';
}

}  // namespace

Json describe_run(const Session& session) {
  since_start();
  const gpu::DeviceInfo& info = gpu::info_of(session.device());
  const std::time_t now = std::time(nullptr);
  return {{"date", fmt::format("{:%Y-%m-%dT%H:%MZ}", fmt::gmtime(now))},
          {"commit", describe_commit()},
          {"compiler", compiler_name()},
          {"device", info.name},
          {"device_type", info.type},
          {"driver", info.driver},
          {"api_version", info.api_version},
          {"has_fp64", session.device().has_fp64()},
          {"times_are", session.device().timestamp_period_ns() > 0.0 ? "device timestamps" : "the host's waiting"},
          {"cpu", cpu_name()},
          {"threads", std::thread::hardware_concurrency()},
          {"command", command_of(session.options())},
          {"runs", session.runs()},
          {"is_quick", session.is_quick()},
          {"is_validated", is_validated()},
          {"load_before", load_average()}};
}

void end_run(Json& report) {
  report["provenance"]["load_after"] = load_average();
  report["provenance"]["minutes"] = since_start().ms() / 60e3;
}

}  // namespace promin::report
