// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vulkan/vulkan.hpp>

namespace promin::gpu {

/// Features that Vulkan leaves to the device. Pictures and rays need none: they are for measurements.
enum class OptionalFeature {
  kFloat64,  ///< Shaders that compute in double.
};

struct FeatureRequest {
  OptionalFeature feature{};
  /// False: the caller does without it where the device lacks it, and asks Device::has_enabled.
  bool is_needed = true;
};

bool has_feature(const vk::PhysicalDeviceFeatures& features, OptionalFeature feature);

/// What to enable of what a device offers: what is asked for and nothing else. Throws DeviceError where it lacks
/// something that is needed. `device` is its name.
vk::PhysicalDeviceFeatures pick_features(const vk::PhysicalDeviceFeatures& offered,
                                         std::span<const FeatureRequest> requests, const std::string& device);

}  // namespace promin::gpu
