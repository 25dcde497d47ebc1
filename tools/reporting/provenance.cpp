// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <string>
#include <thread>

#include "core/stopwatch.h"
#include "device/device.h"

namespace promin::report {
namespace {

const Stopwatch& since_start() {
  static const Stopwatch kStart;
  return kStart;
}

/// Its name, and by what numbers its maker tells models apart, as virtual machines often give several one name.
std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  std::map<std::string, std::string> fields;
  // One block of lines a core, of which the first does.
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
  if (options.side) command += fmt::format(" --side {}", *options.side);
  if (options.builder != "sah") command += fmt::format(" --builder {}", options.builder);
  if (!options.only.empty()) command += fmt::format(" --only {}", fmt::join(options.only, ","));
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
  const std::optional<std::string>& wanted = session.options().device;
  return {{"date", fmt::format("{:%Y-%m-%dT%H:%MZ}", fmt::gmtime(now))},
          {"commit", session.options().commit},
          {"compiler", compiler_name()},
          {"device", info.name},
          {"device_type", info.type},
          {"driver", info.driver},
          {"api_version", info.api_version},
          {"has_fp64", session.device().has_enabled(gpu::OptionalFeature::kFloat64)},
          {"times_are", session.device().timestamp_period_ns() > 0.0 ? "device timestamps" : "the host's waiting"},
          {"cpu", cpu_model()},
          {"threads", std::thread::hardware_concurrency()},
          {"command", command_of(session.options())},
          {"runs", session.runs()},
          {"is_quick", session.is_quick()},
          {"is_validated", is_validated()},
          {"device_wanted", wanted ? Json(*wanted) : Json()},
          {"busy_cores_before", busy_cores()}};
}

void end_run(Json& report) {
  report["provenance"]["busy_cores_after"] = busy_cores();
  report["provenance"]["minutes"] = since_start().ms() / 60e3;
}

}  // namespace promin::report
