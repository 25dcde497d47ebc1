// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "promin/device_info.h"
#include "promin/export.h"

namespace promin::gpu {

/// An open Vulkan device with everything that belongs to it. Its functions are those of this header. Several threads
/// may use one device, each with Renderers and Casters of its own.
class Device;

/// Ends a Device; DeviceHandle calls it.
struct DeviceDeleter {
  /// Frees the device and all that belongs to it.
  PROMIN_EXPORT void operator()(Device* device) const;
};
/// Owns a Device. Every Renderer and Caster that was made with the device must end before it.
using DeviceHandle = std::unique_ptr<Device, DeviceDeleter>;

/// Opens the device that `selection` names: an index of list_devices, "uuid:" with a DeviceInfo::uuid, or a part of a
/// name, case ignored; without one a
/// discrete GPU before an integrated before a virtual one before a CPU.
/// Throws DeviceError if none is usable or none matches, RunError if it fails, and UsageError if PROMIN_VALIDATION
/// (validation_message_count) is none of its words.
PROMIN_EXPORT DeviceHandle open_device(const std::optional<std::string>& selection = std::nullopt);

/// What list_devices tells of this device. Valid while the device is.
PROMIN_EXPORT const DeviceInfo& info_of(const Device& device);

/// Why this device was picked, as one sentence for people. Valid while the device is.
PROMIN_EXPORT const std::string& choice_of(const Device& device);

/// Messages of the validation layers so far (warnings and errors). The layers are on when the environment variable
/// PROMIN_VALIDATION is set and not empty: "core", or "sync" for synchronization validation as well.
PROMIN_EXPORT uint64_t validation_message_count(const Device& device);

}  // namespace promin::gpu
