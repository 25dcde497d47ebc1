// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vulkan/vulkan.hpp>

namespace promin::gpu {

/// Features that Vulkan makes optional. Pictures and rays need none of them; measurements do.
enum class OptionalFeature {
  kFloat64,  ///< Shaders that compute in double.
};

struct FeatureRequest {
  OptionalFeature feature{};
  /// If false, the caller can do without the feature and checks Device::has_enabled.
  bool is_needed = true;
};

bool has_feature(const vk::PhysicalDeviceFeatures& features, OptionalFeature feature);

/// Returns the features to enable: the requested ones that the device offers. Throws DeviceError if a needed one is
/// missing. `device` is its name.
vk::PhysicalDeviceFeatures pick_features(const vk::PhysicalDeviceFeatures& offered,
                                         std::span<const FeatureRequest> requests, const std::string& device);

}  // namespace promin::gpu
