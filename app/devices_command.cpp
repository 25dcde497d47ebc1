// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "devices_command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>

#include "promin/device_info.h"
#include "promin/error.h"

namespace promin::app {
namespace {

void print_devices() {
  const std::vector<gpu::DeviceInfo> devices = gpu::list_devices();
  if (devices.empty()) {
    throw DeviceError({"no Vulkan device found", "", "install a driver, e.g. the package mesa-vulkan-drivers"});
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
}

}  // namespace

Command add_devices_command(CLI::App& program) {
  CLI::App& command = add_command(program, "devices", "Print the Vulkan devices and which one is picked");
  return {&command, print_devices};
}

}  // namespace promin::app
