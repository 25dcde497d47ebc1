// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "promin/export.h"

namespace promin::gpu {

/// A Vulkan device in words.
struct DeviceInfo {
  /// Its place in list_devices, by which open_device takes it too.
  uint32_t index = 0;
  /// As its driver calls it.
  std::string name;
  /// "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other".
  std::string type;
  /// Driver's name and version as it says, e.g. "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)".
  std::string driver;
  /// By which a device is found again, on other days and beside others: 32 hexadecimal digits. Lavapipes all have the
  /// same; empty where the device does not tell.
  std::string uuid;
  /// The version of Vulkan that it speaks, e.g. "1.3.230".
  std::string api_version;
  /// Why the device cannot be used; empty for a usable one.
  std::vector<std::string> obstacles;
  /// Optional features that it does not have and what promin does without them.
  std::vector<std::string> lacks;
  /// Whether open_device takes it where it is not told which.
  bool is_default = false;
};

/// Every Vulkan device that the loader finds, in its order. Empty if there is no driver; throws DeviceError if there
/// is not even a loader.
PROMIN_EXPORT std::vector<DeviceInfo> list_devices();

}  // namespace promin::gpu
