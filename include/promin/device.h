// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "promin/device_info.h"
#include "promin/export.h"

namespace promin::gpu {

/// An open Vulkan device and all objects that belong to it. The functions of this header operate on it. Several threads
/// may use one device if each thread has its own Renderers and Casters.
class Device;

/// Destroys a Device. DeviceHandle calls it.
struct DeviceDeleter {
  /// Frees the device and all objects that belong to it.
  PROMIN_EXPORT void operator()(Device* device) const;
};
/// Owns a Device. The program must destroy every Renderer and Caster of the device before the handle.
using DeviceHandle = std::unique_ptr<Device, DeviceDeleter>;

/// Opens the device that `selection` names: an index of list_devices, "uuid:" with a DeviceInfo::uuid, or a part of a
/// device's name; upper and lower case are equal. Without a selection the function prefers a discrete GPU, then an
/// integrated one, then a virtual one, then a CPU. Throws DeviceError if no device is usable or none matches, RunError
/// if opening fails, and UsageError if PROMIN_VALIDATION (see validation_message_count) has an unknown value.
PROMIN_EXPORT DeviceHandle open_device(const std::optional<std::string>& selection = std::nullopt);

/// Returns the entry of list_devices() for this device. The reference is valid as long as the device exists.
PROMIN_EXPORT const DeviceInfo& info_of(const Device& device);

/// Returns the reason for the choice of this device, as one sentence. The reference is valid as long as the
/// device exists.
PROMIN_EXPORT const std::string& choice_of(const Device& device);

/// Returns the number of warnings and errors of the validation layers so far. The environment variable
/// PROMIN_VALIDATION switches the layers on: "core", or "sync" to add synchronization validation.
PROMIN_EXPORT uint64_t validation_message_count(const Device& device);

}  // namespace promin::gpu
