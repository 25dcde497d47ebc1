// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/optional_features.h"

#include <array>

#include "promin/error.h"

namespace promin::gpu {
namespace {

struct FeatureRow {
  vk::Bool32 vk::PhysicalDeviceFeatures::*member;
  const char* name;
};

/// By OptionalFeature.
constexpr std::array kFeatures{
    FeatureRow{&vk::PhysicalDeviceFeatures::shaderFloat64, "shaderFloat64 (double in shaders)"}};

const FeatureRow& row_of(OptionalFeature feature) {
  return kFeatures.at(static_cast<size_t>(feature));
}

}  // namespace

bool has_feature(const vk::PhysicalDeviceFeatures& features, OptionalFeature feature) {
  return features.*row_of(feature).member == VK_TRUE;
}

vk::PhysicalDeviceFeatures pick_features(const vk::PhysicalDeviceFeatures& offered,
                                         std::span<const FeatureRequest> requests, const std::string& device) {
  vk::PhysicalDeviceFeatures picked;
  for (const FeatureRequest& request : requests) {
    const FeatureRow& row = row_of(request.feature);
    if (has_feature(offered, request.feature)) {
      picked.*row.member = VK_TRUE;
    } else if (request.is_needed) {
      throw DeviceError({"device " + device + " lacks Vulkan's optional feature " + row.name, "which the request needs",
                         "choose another device", Setting::kDevice});
    }
  }
  return picked;
}

}  // namespace promin::gpu
