// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "device/pipeline.h"
#include "device/profile.h"
#include "promin/device.h"
#include "promin/device_info.h"

namespace promin::gpu {

/// The requirements of a window on a device, in addition to tracing.
struct Presentation {
  std::vector<const char*> instance_extensions;
  /// Makes the surface, which the device then owns. Throws DeviceError.
  std::function<VkSurfaceKHR(VkInstance)> make_surface;
};

struct DeviceOptions {
  /// The device to open; see open_device (promin/device.h).
  std::optional<std::string> selection = std::nullopt;
  /// If not null, the device must be able to present to its surface.
  const Presentation* presentation = nullptr;
  /// Replaces the profile's value. Tests set it to 1, because such kernels compile in two thirds of the time.
  std::optional<uint32_t> pixel_packet_size = std::nullopt;
  /// The folder in which the device keeps compiled kernels if its profile recommends it; nullopt: none.
  std::optional<std::filesystem::path> kernel_folder = KernelFolder::usual();
};

/// Runs `work` and converts Vulkan's exceptions to RunErrors, whose sentences name the call and the result.
void translate_vulkan_errors(const std::function<void()>& work);

/// A Vulkan instance and one logical device with one compute queue. With a window the queue also draws and presents.
/// The device needs only the limits that Vulkan 1.1 guarantees. It enables no optional feature, except shader objects
/// if it keeps compiled kernels. Several threads may use a device if each has its own buffers and pipelines.
class Device {
 public:
  /// Opens a device. Throws DeviceError.
  explicit Device(const DeviceOptions& options);
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const { return info_; }
  const std::string& choice() const { return choice_; }
  /// Returns the settings that suit the device.
  const DeviceProfile& profile() const { return profile_; }
  /// Returns the folder in which the device keeps compiled kernels; nullopt if it keeps none.
  const std::optional<std::filesystem::path>& kernel_folder() const { return kernel_folder_; }
  /// Returns the names of the enabled device extensions.
  const std::vector<const char*>& enabled_extensions() const { return enabled_extensions_; }
  uint64_t validation_message_count() const { return *validation_messages_; }

  const vk::raii::Device& handle() const { return device_; }
  const vk::raii::Instance& instance() const { return instance_; }
  const vk::raii::PhysicalDevice& physical() const { return physical_; }
  /// Calls `use` with the queue. No other thread uses the queue meanwhile.
  template <typename Use>
  auto use_queue(const Use& use) const {
    const std::lock_guard lock(queue_mutex_);
    return use(queue_);
  }
  /// Waits until the device has finished all submitted work.
  void wait_idle() const;
  uint32_t queue_family() const { return queue_family_; }
  /// Returns the window's surface; null without a window.
  const vk::raii::SurfaceKHR& surface() const { return surface_; }
  CompiledPipelines& compiled_pipelines() const { return compiled_pipelines_; }
  const vk::PhysicalDeviceLimits& limits() const { return limits_; }
  /// Returns nanoseconds per timestamp tick; 0 if the queue has no timestamps.
  double timestamp_period_ns() const { return timestamp_period_ns_; }
  /// Returns the number of ticks between two timestamps. Timestamps may have fewer than 64 bits.
  uint64_t ticks_between(uint64_t first, uint64_t second) const { return (second - first) & timestamp_mask_; }

  /// Returns the index of the first memory type in `allowed_types` that has all properties of `wanted`, or nullopt.
  std::optional<uint32_t> find_memory_type(uint32_t allowed_types, vk::MemoryPropertyFlags wanted) const;

  /// Records one command buffer, submits it and waits until the device has finished it. Only one thread at a time does
  /// this.
  void run(const std::function<void(const vk::raii::CommandBuffer&)>& record) const;

 private:
  // The members are declared in the order of creation, because each needs the members before it.
  std::unique_ptr<std::atomic<uint64_t>> validation_messages_;
  vk::raii::Context context_;
  vk::raii::Instance instance_{nullptr};
  vk::raii::DebugUtilsMessengerEXT messenger_{nullptr};
  vk::raii::SurfaceKHR surface_{nullptr};
  vk::raii::PhysicalDevice physical_{nullptr};
  vk::PhysicalDeviceLimits limits_;
  vk::PhysicalDeviceMemoryProperties memory_;
  double timestamp_period_ns_ = 0.0;
  uint64_t timestamp_mask_ = 0;
  vk::raii::Device device_{nullptr};
  mutable CompiledPipelines compiled_pipelines_;
  uint32_t queue_family_ = 0;
  vk::raii::Queue queue_{nullptr};
  mutable std::mutex queue_mutex_;
  mutable std::mutex run_mutex_;
  vk::raii::CommandPool pool_{nullptr};
  vk::raii::CommandBuffer commands_{nullptr};
  vk::raii::Fence fence_{nullptr};
  DeviceInfo info_;
  DeviceProfile profile_;
  std::optional<std::filesystem::path> kernel_folder_;
  std::vector<const char*> enabled_extensions_;
  std::string choice_;
};

/// Opens a device in the same way as open_device() of promin/device.h.
DeviceHandle open_device(const DeviceOptions& options);

}  // namespace promin::gpu
