// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/devices_command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "device/driver_files.h"
#include "options/arguments.h"
#include "promin/device_info.h"
#include "promin/error.h"

namespace promin::app {
namespace {

void print_devices_json(const std::vector<gpu::DeviceInfo>& devices) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const gpu::DeviceInfo& device : devices) {
    list.push_back({{"index", device.index},
                    {"name", device.name},
                    {"type", device.type},
                    {"driver", device.driver},
                    {"uuid", device.uuid},
                    {"api_version", device.api_version},
                    {"obstacles", device.obstacles},
                    {"lacks", device.lacks},
                    {"is_default", device.is_default}});
  }
  fmt::print("{}\n", json_text(list, 1));
}

/// Help about the environment variables that select the CPU driver.
constexpr const char* kOfLavapipe = R"(
llvmpipe runs on the host's processor. Variables of the environment that change how fast it is:
  LP_NUM_THREADS=N           its threads, at most 16 [as many as there are cores]; --threads N sets it for one run
  LP_NATIVE_VECTOR_WIDTH=N   bits of a vector, 128, 256 or 512 [as the processor has]; the cache of kernels does not know
                             it, so set MESA_SHADER_CACHE_DISABLE=true beside it
  MESA_SHADER_CACHE_DIR=DIR  where compiled kernels are kept; MESA_SHADER_CACHE_DISABLE=true keeps none
)";

bool is_lavapipe(const gpu::DeviceInfo& device) {
  return device.name.starts_with("llvmpipe");
}

void print_devices(bool is_json) {
  const std::vector<gpu::DeviceInfo> devices = gpu::list_devices();
  if (devices.empty()) {
    throw DeviceError(gpu::explain_missing_driver());
  }
  if (is_json) {
    print_devices_json(devices);
    return;
  }
  size_t name_width = 4;
  size_t type_width = 4;
  size_t driver_width = 6;
  for (const gpu::DeviceInfo& device : devices) {
    name_width = std::max(name_width, device.name.size());
    type_width = std::max(type_width, device.type.size());
    driver_width = std::max(driver_width, device.driver.size());
  }
  const auto print_row = [&](const auto& index, const std::string& name, const std::string& type,
                             const std::string& driver, const std::string& vulkan, const std::string& choice) {
    fmt::print("{:>5}  {:<{}}  {:<{}}  {:<{}}  {:<8}  {}\n", index, name, name_width, type, type_width, driver,
               driver_width, vulkan, choice);
  };
  print_row("index", "name", "type", "driver", "Vulkan", "use");
  for (const gpu::DeviceInfo& device : devices) {
    const char* use = device.is_default ? "picked by default" : device.obstacles.empty() ? "usable" : "unusable";
    print_row(device.index, device.name, device.type, device.driver, device.api_version, use);
    for (const std::string& obstacle : device.obstacles) fmt::print("       cannot be used: {}\n", obstacle);
    for (const std::string& lack : device.lacks) fmt::print("       lacks: {}\n", lack);
  }
  if (std::ranges::any_of(devices, is_lavapipe)) fmt::print("{}", kOfLavapipe);
}

}  // namespace

Command add_devices_command(CLI::App& program) {
  CLI::App& command = add_command(program, "devices", "List the Vulkan devices and mark the default device");
  const auto is_json = std::make_shared<bool>(false);
  OptionTable(command).add_flag("--json", "Print JSON, including the UUIDs that --device accepts", *is_json);
  return {&command, [is_json] { print_devices(*is_json); }};
}

}  // namespace promin::app
