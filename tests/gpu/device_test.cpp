// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

namespace promin::gpu {
namespace {

TEST(DeviceOptionsTest, ADeviceHasNothingOptional) {
  const DeviceHandle device = open_device(std::nullopt, false);
  // Vulkan requires this extension if a program uses a layered driver.
  EXPECT_THAT(device->enabled_extensions(), testing::Each(testing::StrEq("VK_KHR_portability_subset")));
}

TEST(DeviceOptionsTest, OnlyADeviceThatKeepsKernelsHasShaderObjects) {
  const DeviceHandle device = open_device();
  const bool has_them = std::ranges::any_of(
      device->enabled_extensions(), [](const char* name) { return std::string_view(name) == "VK_EXT_shader_object"; });
  EXPECT_EQ(has_them, device->kernel_folder().has_value());
  EXPECT_TRUE(!has_them || device->profile().keeps_kernels);
}

}  // namespace
}  // namespace promin::gpu
