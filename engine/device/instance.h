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

/// Thrown if there is no driver, or no driver has a device.
class NoDriverError : public DeviceError {
 public:
  NoDriverError() : DeviceError(explain_missing_driver()) {}
};

/// Creates a Vulkan 1.1 instance with these extensions, and with the validation layers that PROMIN_VALIDATION requests
/// (promin/device.h). Throws NoDriverError. Throws DeviceError if a requested layer is not installed or the loader
/// fails, for example because of a broken manifest.
vk::raii::Instance make_instance(const vk::raii::Context& context, std::vector<const char*> extensions = {});

/// Returns a messenger that prints validation messages to stderr and counts them; null if validation is off. The
/// counter must outlive the messenger.
vk::raii::DebugUtilsMessengerEXT make_messenger(const vk::raii::Instance& instance, std::atomic<uint64_t>* counter);

}  // namespace promin::gpu
