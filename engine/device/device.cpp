// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/device.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "core/address_space.h"
#include "core/parallel.h"
#include "core/parse_number.h"
#include "device/buffer.h"
#include "device/instance.h"
#include "promin/device.h"
#include "promin/error.h"

namespace promin::gpu {
namespace {

std::string name_of(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return "discrete GPU";
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return "integrated GPU";
    case vk::PhysicalDeviceType::eVirtualGpu:
      return "virtual GPU";
    case vk::PhysicalDeviceType::eCpu:
      return "CPU";
    default:
      return "other";
  }
}

/// Returns the rank of a type of device. The device with the lowest rank is the default.
int rank_of(const std::string& type) {
  const std::array order{"discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"};
  return static_cast<int>(std::find(order.begin(), order.end(), type) - order.begin());
}

std::string version_text(uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

/// Returns a queue family that can compute and, if there is a surface, draw and present to the surface.
std::optional<uint32_t> find_family(const vk::raii::PhysicalDevice& device, vk::SurfaceKHR surface) {
  using Flag = vk::QueueFlagBits;
  const vk::QueueFlags wanted = surface ? Flag::eCompute | Flag::eGraphics : vk::QueueFlags(Flag::eCompute);
  const auto families = device.getQueueFamilyProperties();
  for (uint32_t i = 0; i < families.size(); ++i) {
    const bool is_able = (families[i].queueFlags & wanted) == wanted;
    if (is_able && (!surface || device.getSurfaceSupportKHR(i, surface))) return i;
  }
  return std::nullopt;
}

bool has_device_extension(const vk::raii::PhysicalDevice& device, std::string_view name) {
  const auto extensions = device.enumerateDeviceExtensionProperties();
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& e) { return name == e.extensionName.data(); });
}

bool has_shader_objects(const vk::raii::PhysicalDevice& device) {
  const auto names = shader_object_extensions();
  return !names.empty() && std::ranges::all_of(names, [&](const char* n) { return has_device_extension(device, n); });
}

/// Returns the driver's properties; empty if the driver reports none.
std::optional<vk::PhysicalDeviceDriverProperties> driver_properties(const vk::raii::PhysicalDevice& device,
                                                                    const vk::PhysicalDeviceProperties& properties) {
  if (properties.apiVersion < VK_API_VERSION_1_2 &&
      !has_device_extension(device, VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME)) {
    return std::nullopt;
  }
  const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
  return chain.get<vk::PhysicalDeviceDriverProperties>();
}

std::string driver_text(const vk::raii::PhysicalDevice& device, const vk::PhysicalDeviceProperties& properties) {
  const auto driver = driver_properties(device, properties);
  if (!driver) return "driver " + version_text(properties.driverVersion);
  const std::string name = driver->driverName.data();
  const std::string version = driver->driverInfo.data();
  return version.empty() ? name : name + " " + version;
}

DeviceTraits traits_of(const vk::raii::PhysicalDevice& device, const vk::PhysicalDeviceProperties& properties) {
  const auto driver = driver_properties(device, properties);
  return {.is_cpu = properties.deviceType == vk::PhysicalDeviceType::eCpu,
          .driver_id = driver ? static_cast<uint32_t>(driver->driverID) : 0,
          .driver_info = driver ? std::string(driver->driverInfo) : std::string(),
          .core_count = core_count(),
          .has_shader_objects = has_shader_objects(device),
          .texel_buffer_bytes = properties.limits.maxTexelBufferElements * kTexelBytes};
}

std::string uuid_of(const vk::raii::PhysicalDevice& device) {
  const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceIDProperties>();
  std::string text;
  for (const uint8_t byte : chain.get<vk::PhysicalDeviceIDProperties>().deviceUUID) {
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  }
  return text;
}

DeviceInfo describe(const vk::raii::PhysicalDevice& device, uint32_t index, vk::SurfaceKHR surface) {
  const vk::PhysicalDeviceProperties properties = device.getProperties();
  DeviceInfo info;
  info.index = index;
  info.name = properties.deviceName.data();
  info.type = name_of(properties.deviceType);
  info.api_version = version_text(properties.apiVersion);
  if (properties.apiVersion < VK_API_VERSION_1_1) {
    info.driver = "driver " + version_text(properties.driverVersion);
    info.obstacles.push_back("it has only Vulkan " + info.api_version + ", 1.1 is needed");
    return info;
  }
  info.driver = driver_text(device, properties);
  info.uuid = uuid_of(device);
  if (!find_family(device, {})) {
    info.obstacles.emplace_back("it has no compute queue");
    return info;
  }
  const auto family = find_family(device, surface);
  if (!family || (surface && !has_device_extension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME))) {
    info.obstacles.emplace_back("it cannot present to this window; promin render needs none");
    return info;
  }
  if (device.getQueueFamilyProperties()[*family].timestampValidBits == 0) {
    info.lacks.emplace_back("timestamps (times are the host's)");
  }
  return info;
}

std::vector<DeviceInfo> describe_all(const std::vector<vk::raii::PhysicalDevice>& devices, vk::SurfaceKHR surface) {
  std::vector<DeviceInfo> infos;
  for (uint32_t i = 0; i < devices.size(); ++i) infos.push_back(describe(devices[i], i, surface));
  const auto best = std::min_element(infos.begin(), infos.end(), [](const DeviceInfo& a, const DeviceInfo& b) {
    const auto key = [](const DeviceInfo& d) { return std::pair(!d.obstacles.empty(), rank_of(d.type)); };
    return key(a) < key(b);
  });
  if (best != infos.end() && best->obstacles.empty()) best->is_default = true;
  return infos;
}

std::vector<vk::raii::PhysicalDevice> enumerate(const vk::raii::Instance& instance) {
  try {
    return instance.enumeratePhysicalDevices();
  } catch (const vk::InitializationFailedError&) {
    return {};  // The loader finds no driver.
  }
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string list_names(const std::vector<DeviceInfo>& infos) {
  std::string text;
  for (const DeviceInfo& info : infos) {
    text += (text.empty() ? "" : ", ") + std::to_string(info.index) + " " + info.name;
  }
  return text;
}

constexpr std::string_view kByUuid = "uuid:";

/// Returns the index into `infos`: the selection is a number, a UUID with its prefix, or a part of the name.
size_t select_device(const std::vector<DeviceInfo>& infos, const std::optional<std::string>& selection) {
  if (infos.empty()) throw NoDriverError();
  for (size_t i = 0; i < infos.size(); ++i) {
    if (!selection && infos[i].is_default) return i;
  }
  if (!selection) {
    throw DeviceError({"device.missing",
                       "there is no usable Vulkan device (" + infos[0].name + ": " + infos[0].obstacles[0] + ")", "",
                       "install a driver such as mesa-vulkan-drivers"});
  }
  const std::optional<size_t> number = to_number<size_t>(*selection);
  for (size_t i = 0; i < infos.size(); ++i) {
    // An empty text is contained in every name, so it is not a selection.
    const bool is_part =
        !selection->empty() && lower_case(infos[i].name).find(lower_case(*selection)) != std::string::npos;
    const bool is_uuid = lower_case(*selection) == std::string(kByUuid) + infos[i].uuid;
    const bool matches = number ? i == *number : is_part || is_uuid;
    if (!matches) continue;
    if (!infos[i].obstacles.empty()) {
      throw DeviceError({"device.unusable",
                         "the requested device " + infos[i].name + " cannot be used: " + infos[i].obstacles[0], "",
                         "use another device: " + list_names(infos), Setting::kDevice});
    }
    return i;
  }
  throw DeviceError({"device.unknown", "no Vulkan device matches \"" + *selection + "\"", "",
                     "use another device: " + list_names(infos), Setting::kDevice});
}

[[noreturn]] void refuse_few_threads(const std::string& name) {
  Problem problem = explain_no_threads();
  problem.what += ", and " + name + " needs one";
  throw DeviceError(problem);
}

/// Creates the logical device. CPU drivers start their threads here. If the system refuses some threads, a driver fails
/// without a reason, or it reports nothing and the first dispatch waits forever. In both cases the system also refuses
/// another thread afterwards, which this function tests.
vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical, const vk::DeviceCreateInfo& info,
                             const std::string& name) {
  try {
    vk::raii::Device device(physical, info);
    if (!can_start_threads(1)) refuse_few_threads(name);
    return device;
  } catch (const vk::SystemError&) {
    if (!can_start_threads(1)) refuse_few_threads(name);
    throw;
  }
}

}  // namespace

void translate_vulkan_errors(const std::function<void()>& work) {
  try {
    work();
  } catch (const vk::OutOfDeviceMemoryError& error) {
    throw RunError({"device.memory.short", std::string("the device has not enough memory (") + error.what() + ")", "",
                    cure_short_memory("use a smaller scene or picture, or another device"), Setting::kDevice});
  } catch (const vk::OutOfHostMemoryError& error) {
    throw RunError({"host.memory.short", std::string("the host has not enough memory (") + error.what() + ")", "",
                    cure_short_memory("use a smaller scene or picture")});
  } catch (const vk::DeviceLostError& error) {
    throw RunError({"device.lost", std::string("the device was lost (") + error.what() + ")", "",
                    "try again, or another device", Setting::kDevice});
  } catch (const vk::SystemError& error) {
    throw RunError({"device.call.failed", std::string("a Vulkan call failed (") + error.what() + ")", "",
                    "try another device", Setting::kDevice});
  }
}

Device::Device(const DeviceOptions& options)
    : validation_messages_(std::make_unique<std::atomic<uint64_t>>(0)),
      context_(load_vulkan()),
      instance_(make_instance(context_, options.presentation != nullptr ? options.presentation->instance_extensions
                                                                        : std::vector<const char*>())),
      messenger_(make_messenger(instance_, validation_messages_.get())) {
  if (options.presentation != nullptr) {
    surface_ = vk::raii::SurfaceKHR(instance_, options.presentation->make_surface(*instance_));
  }
  auto devices = enumerate(instance_);
  const std::vector<DeviceInfo> infos = describe_all(devices, *surface_);
  const size_t index = select_device(infos, options.selection);
  physical_ = std::move(devices[index]);
  info_ = infos[index];
  choice_ = "using " + info_.name + " (" + info_.type + ", " + info_.driver + "), " +
            (options.selection   ? "requested as the device"
             : infos.size() == 1 ? "the only Vulkan device"
                                 : "the first of the best kind among " + std::to_string(infos.size()) + " devices");
  translate_vulkan_errors([&] {
    const vk::PhysicalDeviceProperties properties = physical_.getProperties();
    limits_ = properties.limits;
    profile_ = make_profile(traits_of(physical_, properties));
    profile_.pixel_packet_size = options.pixel_packet_size.value_or(profile_.pixel_packet_size);
    memory_ = physical_.getMemoryProperties();
    queue_family_ = *find_family(physical_, *surface_);
    if (const uint32_t bits = physical_.getQueueFamilyProperties()[queue_family_].timestampValidBits; bits > 0) {
      timestamp_period_ns_ = limits_.timestampPeriod;
      timestamp_mask_ = ~uint64_t{0} >> (64 - bits);
    }
    const float priority = 1.0F;
    const vk::DeviceQueueCreateInfo queue_info({}, queue_family_, 1, &priority);
    // A layered driver requires that this extension is enabled.
    if (has_device_extension(physical_, "VK_KHR_portability_subset")) {
      enabled_extensions_.push_back("VK_KHR_portability_subset");
    }
    if (options.presentation != nullptr) enabled_extensions_.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    if (profile_.keeps_kernels) kernel_folder_ = options.kernel_folder;
    if (kernel_folder_) {
      const auto names = shader_object_extensions();
      enabled_extensions_.insert(enabled_extensions_.end(), names.begin(), names.end());
    }
    vk::DeviceCreateInfo device_info({}, queue_info, {}, enabled_extensions_);
    if (kernel_folder_) device_info.pNext = shader_object_features();
    device_ = make_device(physical_, device_info, info_.name);
    if (kernel_folder_) compiled_pipelines_.keep_binaries(physical_, *kernel_folder_);
    queue_ = vk::raii::Queue(device_, queue_family_, 0);
    pool_ = vk::raii::CommandPool(
        device_, vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer, queue_family_));
    commands_ = std::move(
        vk::raii::CommandBuffers(device_, vk::CommandBufferAllocateInfo(*pool_, vk::CommandBufferLevel::ePrimary, 1))
            .front());
    fence_ = vk::raii::Fence(device_, vk::FenceCreateInfo());
    check_file_size_limit(*this);
  });
}

std::optional<uint32_t> Device::find_memory_type(uint32_t allowed_types, vk::MemoryPropertyFlags wanted) const {
  for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
    const bool is_allowed = ((allowed_types >> i) & 1U) != 0;
    if (is_allowed && (memory_.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  }
  return std::nullopt;
}

void Device::wait_idle() const {
  // Vulkan treats waiting for the device as a use of all queues.
  const std::lock_guard lock(queue_mutex_);
  device_.waitIdle();
}

void Device::run(const std::function<void(const vk::raii::CommandBuffer&)>& record) const {
  const std::lock_guard lock(run_mutex_);
  commands_.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  record(commands_);
  commands_.end();
  vk::SubmitInfo submit;
  const vk::CommandBuffer buffer = *commands_;
  submit.setCommandBuffers(buffer);
  use_queue([&](const vk::raii::Queue& queue) { queue.submit(submit, *fence_); });
  // A device that does not answer for this long is lost, because every dispatch is short.
  const double most_s = profile_.most_silence_s;
  const vk::Result result = device_.waitForFences({*fence_}, VK_TRUE, static_cast<uint64_t>(1e9 * most_s));
  if (result != vk::Result::eSuccess) {
    throw vk::DeviceLostError("vk::Device::waitForFences: no answer for " + std::to_string(std::lround(most_s)) + " s");
  }
  device_.resetFences({*fence_});
}

std::vector<DeviceInfo> list_devices() {
  const vk::raii::Context context = load_vulkan();
  try {
    const vk::raii::Instance instance = make_instance(context);
    return describe_all(enumerate(instance), {});
  } catch (const NoDriverError&) {
    return {};
  }
}

void DeviceDeleter::operator()(Device* device) const {
  delete device;
}

DeviceHandle open_device(const std::optional<std::string>& selection, bool keeps_kernels) {
  DeviceOptions options{.selection = selection};
  if (!keeps_kernels) options.kernel_folder.reset();
  return open_device(options);
}

DeviceHandle open_device(const DeviceOptions& options) {
  if (const auto problem = find_lack_of_address_space()) throw DeviceError(*problem);
  return DeviceHandle(new Device(options));
}

const DeviceInfo& info_of(const Device& device) {
  return device.info();
}
const std::string& choice_of(const Device& device) {
  return device.choice();
}
KernelStats kernel_stats_of(const Device& device) {
  return device.compiled_pipelines().stats();
}
uint64_t validation_message_count(const Device& device) {
  return device.validation_message_count();
}

}  // namespace promin::gpu
