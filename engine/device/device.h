// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "device/optional_features.h"
#include "device/pipeline.h"
#include "device/profile.h"
#include "promin/device.h"
#include "promin/device_info.h"

namespace promin::gpu {

/// What a window asks of a device beside tracing.
struct Presentation {
  std::vector<const char*> instance_extensions;
  /// Makes the surface, which the device will own. Throws DeviceError.
  std::function<VkSurfaceKHR(VkInstance)> make_surface;
};

struct DeviceOptions {
  /// See open_device (promin/device.h).
  std::optional<std::string> selection = std::nullopt;
  /// Where not null, a device that can present to its surface.
  const Presentation* presentation = nullptr;
  /// Optional features to enable; no other is.
  std::vector<FeatureRequest> features = {};
  /// Replaces the profile's. Tests set it to 1: such kernels compile in two thirds of the time.
  std::optional<uint32_t> pixel_packet_size = std::nullopt;
};

/// Runs `work` and turns Vulkan's exceptions into RunError sentences that name the call and the result.
void translate_vulkan_errors(const std::function<void()>& work);

/// A Vulkan instance and one logical device with one queue that computes; for a window it draws and presents as well.
/// Needs nothing beyond Vulkan 1.1's required minima, and enables nothing beyond them that is not asked for. Several
/// threads may use a device, each its own buffers and pipelines.
class Device {
 public:
  /// Throws DeviceError.
  explicit Device(const DeviceOptions& options);
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const { return info_; }
  const std::string& choice() const { return choice_; }
  /// What suits it.
  const DeviceProfile& profile() const { return profile_; }
  /// Whether a feature that was asked for is there.
  bool has_enabled(OptionalFeature feature) const { return has_feature(enabled_features_, feature); }
  const vk::PhysicalDeviceFeatures& enabled_features() const { return enabled_features_; }
  /// Names of the device's extensions that are on.
  const std::vector<const char*>& enabled_extensions() const { return enabled_extensions_; }
  uint64_t validation_message_count() const { return *validation_messages_; }

  const vk::raii::Device& handle() const { return device_; }
  const vk::raii::Instance& instance() const { return instance_; }
  const vk::raii::PhysicalDevice& physical() const { return physical_; }
  /// Calls `use` with the queue while no other thread uses it.
  template <typename Use>
  auto use_queue(const Use& use) const {
    const std::lock_guard lock(queue_mutex_);
    return use(queue_);
  }
  /// Waits until nothing that was submitted is left to do.
  void wait_idle() const;
  uint32_t queue_family() const { return queue_family_; }
  /// Null without a window.
  const vk::raii::SurfaceKHR& surface() const { return surface_; }
  CompiledPipelines& compiled_pipelines() const { return compiled_pipelines_; }
  const vk::PhysicalDeviceLimits& limits() const { return limits_; }
  /// Nanoseconds a timestamp tick; 0 where the queue has no timestamps.
  double timestamp_period_ns() const { return timestamp_period_ns_; }
  /// Ticks between two timestamps, of which the device may have fewer than 64 bits.
  uint64_t ticks_between(uint64_t first, uint64_t second) const { return (second - first) & timestamp_mask_; }

  /// Index of the first memory type in `allowed_types` that has all of `wanted`, or none.
  std::optional<uint32_t> find_memory_type(uint32_t allowed_types, vk::MemoryPropertyFlags wanted) const;

  /// Records one command buffer, submits it and waits until the device has finished; one thread after the other.
  void run(const std::function<void(const vk::raii::CommandBuffer&)>& record) const;

 private:
  // Declared in the order of their making: each needs those before it.
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
  vk::PhysicalDeviceFeatures enabled_features_;
  std::vector<const char*> enabled_extensions_;
  std::string choice_;
};

/// As open_device of promin/device.h.
DeviceHandle open_device(const DeviceOptions& options);

}  // namespace promin::gpu
