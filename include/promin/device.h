// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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
///
/// With `keeps_kernels`, promin keeps compiled kernels in the folder promin/kernels of $XDG_CACHE_HOME or ~/.cache, if
/// the driver supports this and gains from it. Pictures and hits have the same bits without.
PROMIN_EXPORT DeviceHandle open_device(const std::optional<std::string>& selection = std::nullopt,
                                       bool keeps_kernels = true);

/// Returns the entry of list_devices() for this device. The reference is valid as long as the device exists.
PROMIN_EXPORT const DeviceInfo& info_of(const Device& device);

/// Returns the reason for the choice of this device, as one sentence. The reference is valid as long as the
/// device exists.
PROMIN_EXPORT const std::string& choice_of(const Device& device);

/// Counts of the kernels that a device has made since it was opened.
struct KernelStats {
  /// Number of kernels that the driver compiled from SPIR-V.
  uint64_t compiled = 0;
  /// Number of kernels whose binaries promin read from `folder`.
  uint64_t read = 0;
  /// The folder in which promin keeps compiled kernels; empty if it keeps none.
  std::filesystem::path folder;
  /// Notes for users who want to see every step, such as the reason why kernels cannot be kept.
  std::vector<std::string> notes;
};

/// Returns the counts of a device's kernels.
PROMIN_EXPORT KernelStats kernel_stats_of(const Device& device);

/// Returns the number of warnings and errors of the validation layers so far. The environment variable
/// PROMIN_VALIDATION switches the layers on: "core", or "sync" to add synchronization validation.
PROMIN_EXPORT uint64_t validation_message_count(const Device& device);

}  // namespace promin::gpu
