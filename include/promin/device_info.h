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
  /// The device's index in the result of list_devices(). open_device() accepts this index.
  uint32_t index = 0;
  /// The name that the driver reports.
  std::string name;
  /// "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other".
  std::string type;
  /// Name and version that the driver reports, e.g. "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)".
  std::string driver;
  /// A permanent identifier of the device, 32 hexadecimal digits, which distinguishes it from other devices. All
  /// lavapipe devices have the same identifier. Empty if the device reports none.
  std::string uuid;
  /// The Vulkan version that the device supports, e.g. "1.3.230".
  std::string api_version;
  /// Reasons why promin cannot use the device; empty for a usable device.
  std::vector<std::string> obstacles;
  /// Optional features that the device lacks, and what promin does without them.
  std::vector<std::string> lacks;
  /// True if open_device opens this device by default.
  bool is_default = false;
};

/// Returns all Vulkan devices that the loader finds, in the loader's order. The list is empty if there is no driver.
/// Throws DeviceError if there is no loader.
PROMIN_EXPORT std::vector<DeviceInfo> list_devices();

}  // namespace promin::gpu
