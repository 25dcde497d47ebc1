// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "promin/export.h"

namespace promin::gpu {

/// A description of a Vulkan device.
struct DeviceInfo {
  /// Its index in list_devices, which open_device accepts too.
  uint32_t index = 0;
  /// The name that its driver gives.
  std::string name;
  /// "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other".
  std::string type;
  /// Name and version that the driver gives, e.g. "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)".
  std::string driver;
  /// Identifies the device permanently and among several: 32 hexadecimal digits. All lavapipe devices have the same
  /// one. Empty if the device reports none.
  std::string uuid;
  /// The Vulkan version that it supports, e.g. "1.3.230".
  std::string api_version;
  /// Reasons why the device cannot be used; empty for a usable one.
  std::vector<std::string> obstacles;
  /// Optional features that it lacks, and what promin does without them.
  std::vector<std::string> lacks;
  /// Whether open_device opens this device by default.
  bool is_default = false;
};

/// Returns all Vulkan devices that the loader finds, in its order; empty if there is no driver. Throws DeviceError if
/// there is no loader.
PROMIN_EXPORT std::vector<DeviceInfo> list_devices();

}  // namespace promin::gpu
