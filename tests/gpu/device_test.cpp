// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace promin::gpu {
namespace {

TEST(DeviceOptionsTest, ADeviceHasNothingOptional) {
  const DeviceHandle device = open_device();
  // Vulkan requires this extension if a program uses a layered driver.
  EXPECT_THAT(device->enabled_extensions(), testing::Each(testing::StrEq("VK_KHR_portability_subset")));
}

}  // namespace
}  // namespace promin::gpu
