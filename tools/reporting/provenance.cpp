// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>

#include "core/stopwatch.h"
#include "device/device.h"
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

/// Of all cores since the system started, in ticks; nothing where the system does not tell.
struct CoreTimes {
  double busy = 0.0;
  double all = 0.0;
};

CoreTimes read_core_times() {
  std::ifstream file("/proc/stat");
  std::string name;
  CoreTimes times;
  if (!(file >> name)) return times;
  // user, nice, system, idle, iowait, irq, softirq, steal; what follows is in the first two (proc(5)).
  std::array<double, 8> ticks{};
  for (double& part : ticks) file >> part;
  for (const double part : ticks) times.all += part;
  times.busy = times.all - ticks[3] - ticks[4];
  return times;
}

/// Cores that others keep busy, over a second in which this program does nothing. Not the load average: that remembers
/// the report before for minutes.
Json busy_cores() {
  const CoreTimes before = read_core_times();
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const CoreTimes after = read_core_times();
  if (!(after.all > before.all)) return {};
  return std::thread::hardware_concurrency() * (after.busy - before.busy) / (after.all - before.all);
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
  const std::filesystem::path output = options.output.has_filename() ? options.output : options.output.parent_path();
  return command + fmt::format(" -o {}", output.filename().string());
}

/// Whether Vulkan's validation layers watch (include/promin/device.h), which takes time.
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
          {"busy_cores_before", busy_cores()}};
}

void end_run(Json& report) {
  report["provenance"]["busy_cores_after"] = busy_cores();
  report["provenance"]["minutes"] = since_start().ms() / 60e3;
}

}  // namespace promin::report
