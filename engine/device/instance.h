// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "device/driver_files.h"
#include "promin/error.h"

namespace promin::gpu {

/// Loads the Vulkan loader. Throws DeviceError if none is installed.
vk::raii::Context load_vulkan();

/// There is no driver, or none that has a device.
class NoDriverError : public DeviceError {
 public:
  NoDriverError() : DeviceError(explain_missing_driver()) {}
};

/// An instance for Vulkan 1.1 with these extensions, with the validation layers that PROMIN_VALIDATION requests
/// (promin/device.h). Throws NoDriverError, and DeviceError if a requested layer is not installed or the loader fails,
/// for example because of a broken manifest.
vk::raii::Instance make_instance(const vk::raii::Context& context, std::vector<const char*> extensions = {});

/// Prints validation messages to stderr and counts them; null if validation is off. The counter must outlive it.
vk::raii::DebugUtilsMessengerEXT make_messenger(const vk::raii::Instance& instance, std::atomic<uint64_t>* counter);

}  // namespace promin::gpu
