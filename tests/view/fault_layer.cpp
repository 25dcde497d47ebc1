// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// This Vulkan layer makes one call fail, as a driver would. PROMIN_TEST_FAULT says which one: "vkQueueSubmit 40 -4"
// gives the 40th submission the result -4, VK_ERROR_DEVICE_LOST. The layer supports one instance with one device.

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>

#define LAYER_EXPORT extern "C" __attribute__((visibility("default"))) VKAPI_ATTR

namespace {

PFN_vkGetInstanceProcAddr next_instance_proc = nullptr;
PFN_vkGetDeviceProcAddr next_device_proc = nullptr;
VkDevice the_device = VK_NULL_HANDLE;

struct Fault {
  std::string call;
  int number = 0;
  int result = VK_SUCCESS;
};

Fault read_fault() {
  Fault fault;
  const char* text = std::getenv("PROMIN_TEST_FAULT");
  std::istringstream(text == nullptr ? "" : text) >> fault.call >> fault.number >> fault.result;
  return fault;
}

/// Returns the result of this call: an error if PROMIN_TEST_FAULT selects the call.
VkResult fail(const char* call) {
  static const Fault fault = read_fault();
  static std::atomic<int> count = 0;
  if (fault.call != call || ++count != fault.number) return VK_SUCCESS;
  return static_cast<VkResult>(fault.result);
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(next_device_proc(the_device, name));
}

/// Returns the loader's information on the next layer, from the chain of a create info.
template <typename Link>
Link* find_link(const void* chain, VkStructureType type) {
  for (auto* item = static_cast<const Link*>(chain); item != nullptr; item = static_cast<const Link*>(item->pNext)) {
    if (item->sType == type && item->function == VK_LAYER_LINK_INFO) return const_cast<Link*>(item);
  }
  return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
  auto* link = find_link<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  next_instance_proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  return reinterpret_cast<PFN_vkCreateInstance>(next_instance_proc(nullptr, "vkCreateInstance"))(info, allocator,
                                                                                                 instance);
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
  auto* link = find_link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  next_device_proc = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  const auto create =
      reinterpret_cast<PFN_vkCreateDevice>(link->u.pLayerInfo->pfnNextGetInstanceProcAddr(nullptr, "vkCreateDevice"));
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const VkResult result = create(physical, info, allocator, device);
  the_device = *device;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL queue_submit(VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence) {
  if (const VkResult result = fail("vkQueueSubmit"); result != VK_SUCCESS) return result;
  return next<PFN_vkQueueSubmit>("vkQueueSubmit")(queue, count, submits, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
  if (const VkResult result = fail("vkAllocateMemory"); result != VK_SUCCESS) return result;
  return next<PFN_vkAllocateMemory>("vkAllocateMemory")(device, info, allocator, memory);
}

VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                const VkComputePipelineCreateInfo* infos,
                                                const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  if (const VkResult result = fail("vkCreateComputePipelines"); result != VK_SUCCESS) return result;
  return next<PFN_vkCreateComputePipelines>("vkCreateComputePipelines")(device, cache, count, infos, allocator,
                                                                        pipelines);
}

#ifdef VK_EXT_shader_object
VKAPI_ATTR VkResult VKAPI_CALL create_shaders(VkDevice device, uint32_t count, const VkShaderCreateInfoEXT* infos,
                                              const VkAllocationCallbacks* allocator, VkShaderEXT* shaders) {
  if (const VkResult result = fail("vkCreateShadersEXT"); result != VK_SUCCESS) return result;
  return next<PFN_vkCreateShadersEXT>("vkCreateShadersEXT")(device, count, infos, allocator, shaders);
}
#endif

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_proc(VkInstance instance, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc(VkDevice device, const char* name);

PFN_vkVoidFunction find_own(const char* name) {
  const auto is = [&](const char* other) { return std::strcmp(name, other) == 0; };
  if (is("vkGetInstanceProcAddr")) return reinterpret_cast<PFN_vkVoidFunction>(get_instance_proc);
  if (is("vkGetDeviceProcAddr")) return reinterpret_cast<PFN_vkVoidFunction>(get_device_proc);
  if (is("vkCreateInstance")) return reinterpret_cast<PFN_vkVoidFunction>(create_instance);
  if (is("vkCreateDevice")) return reinterpret_cast<PFN_vkVoidFunction>(create_device);
  if (is("vkQueueSubmit")) return reinterpret_cast<PFN_vkVoidFunction>(queue_submit);
  if (is("vkAllocateMemory")) return reinterpret_cast<PFN_vkVoidFunction>(allocate_memory);
  if (is("vkCreateComputePipelines")) return reinterpret_cast<PFN_vkVoidFunction>(create_pipelines);
#ifdef VK_EXT_shader_object
  if (is("vkCreateShadersEXT")) return reinterpret_cast<PFN_vkVoidFunction>(create_shaders);
#endif
  return nullptr;
}

PFN_vkVoidFunction get_instance_proc(VkInstance instance, const char* name) {
  const PFN_vkVoidFunction own = find_own(name);
  if (own != nullptr || next_instance_proc == nullptr) return own;
  return next_instance_proc(instance, name);
}

PFN_vkVoidFunction get_device_proc(VkDevice device, const char* name) {
  const PFN_vkVoidFunction own = find_own(name);
  return own != nullptr ? own : next_device_proc(device, name);
}

}  // namespace

LAYER_EXPORT VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
  version->loaderLayerInterfaceVersion = 2;
  version->pfnGetInstanceProcAddr = get_instance_proc;
  version->pfnGetDeviceProcAddr = get_device_proc;
  version->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
