// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/instance.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "promin/error.h"

namespace promin::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

std::string validation_mode() {
  const char* mode = std::getenv("PROMIN_VALIDATION");
  return mode == nullptr ? "" : mode;
}

bool has_extension(const vk::raii::Context& context, std::string_view name) {
  const auto extensions = context.enumerateInstanceExtensionProperties();
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& e) { return name == e.extensionName.data(); });
}

bool has_layer(const vk::raii::Context& context, std::string_view name) {
  const auto layers = context.enumerateInstanceLayerProperties();
  return std::any_of(layers.begin(), layers.end(), [&](const auto& l) { return name == l.layerName.data(); });
}

VKAPI_ATTR VkBool32 VKAPI_CALL count_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                             const VkDebugUtilsMessengerCallbackDataEXT* data, void* counter) {
  static_cast<std::atomic<uint64_t>*>(counter)->fetch_add(1);
  std::fprintf(stderr, "validation: %s\n", data->pMessage);
  return VK_FALSE;
}

}  // namespace

vk::raii::Context load_vulkan() {
  try {
    return {};
  } catch (const std::exception&) {
    throw DeviceError({"device.loader.missing", "the Vulkan loader is missing", "",
                       "install libvulkan1 and a driver such as "
                       "mesa-vulkan-drivers"});
  }
}

namespace {

vk::raii::Instance try_make_instance(const vk::raii::Context& context, std::vector<const char*> extensions) {
  const std::string mode = validation_mode();
  std::vector<const char*> layers;
  vk::InstanceCreateFlags flags;
  if (!mode.empty()) {
    if (mode != "core" && mode != "sync") {
      throw UsageError(
          {"device.validation.mode", "there is no validation mode " + mode, "PROMIN_VALIDATION", "use core or sync"});
    }
    if (!has_layer(context, kValidationLayer)) {
      throw DeviceError({"device.validation.missing", std::string(kValidationLayer) + " is not installed",
                         "PROMIN_VALIDATION", "install vulkan-validationlayers"});
    }
    layers.push_back(kValidationLayer);
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }
  // The loader lists layered drivers such as MoltenVK only on request.
  if (has_extension(context, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) {
    extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    flags |= vk::InstanceCreateFlagBits::eEnumeratePortabilityKHR;
  }
  const vk::ApplicationInfo application("promin", 1, "promin", 1, VK_API_VERSION_1_1);
  const std::array synchronization{vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
  const vk::ValidationFeaturesEXT features(synchronization);
  vk::InstanceCreateInfo info(flags, &application, layers, extensions);
  if (mode == "sync") info.pNext = &features;
  return {context, info};
}

}  // namespace

vk::raii::Instance make_instance(const vk::raii::Context& context, std::vector<const char*> extensions) {
  try {
    return try_make_instance(context, std::move(extensions));
  } catch (const vk::IncompatibleDriverError&) {
    throw NoDriverError();
  } catch (const vk::SystemError& error) {
    // The loader reports OutOfHostMemory for a manifest that is not JSON.
    if (find_manifest_fault()) throw NoDriverError();
    throw DeviceError({"device.vulkan.start", std::string("Vulkan cannot start (") + error.what() + ")", "",
                       "install a Vulkan 1.1 driver such as mesa-vulkan-drivers"});
  }
}

vk::raii::DebugUtilsMessengerEXT make_messenger(const vk::raii::Instance& instance, std::atomic<uint64_t>* counter) {
  if (validation_mode().empty()) return nullptr;
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  VkDebugUtilsMessengerCreateInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  info.messageSeverity = static_cast<VkDebugUtilsMessageSeverityFlagsEXT>(Severity::eWarning | Severity::eError);
  info.messageType = static_cast<VkDebugUtilsMessageTypeFlagsEXT>(Type::eValidation | Type::ePerformance);
  info.pfnUserCallback = count_message;
  info.pUserData = counter;
  return {instance, vk::DebugUtilsMessengerCreateInfoEXT(info)};
}

}  // namespace promin::gpu
