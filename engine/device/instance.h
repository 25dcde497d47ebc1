// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "device/driver_files.h"
#include "promin/error.h"

namespace promin::gpu {

/// The Vulkan loader. Throws DeviceError where none is installed.
vk::raii::Context load_vulkan();

/// There is no driver, or none that has a device.
class NoDriverError : public DeviceError {
 public:
  NoDriverError() : DeviceError(explain_missing_driver()) {}
};

/// An instance for Vulkan 1.1 with these extensions, with the validation layers that PROMIN_VALIDATION asks for
/// (promin/device.h). Throws NoDriverError, and DeviceError if a layer is asked for that is not installed or the loader
/// does not start, as with a broken manifest.
vk::raii::Instance make_instance(const vk::raii::Context& context, std::vector<const char*> extensions = {});

/// Prints validation messages to stderr and counts them; null where validation is off. The counter must outlive it.
vk::raii::DebugUtilsMessengerEXT make_messenger(const vk::raii::Instance& instance, std::atomic<uint64_t>* counter);

}  // namespace promin::gpu
