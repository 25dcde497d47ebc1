// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "promin/error.h"

namespace promin::gpu {
namespace {

constexpr FeatureRequest kNeeded{.feature = OptionalFeature::kFloat64};
constexpr FeatureRequest kWelcome{.feature = OptionalFeature::kFloat64, .is_needed = false};

// All that a device may have, so that what is not asked for is seen not to be taken.
vk::PhysicalDeviceFeatures make_all_features() {
  vk::PhysicalDeviceFeatures all;
  all.shaderFloat64 = VK_TRUE;
  all.shaderInt64 = VK_TRUE;
  all.robustBufferAccess = VK_TRUE;
  return all;
}

TEST(OptionalFeaturesTest, NothingIsEnabledThatIsNotAskedFor) {
  EXPECT_EQ(pick_features(make_all_features(), {}, "a device"), vk::PhysicalDeviceFeatures());
}

TEST(OptionalFeaturesTest, WhatIsAskedForIsEnabledAlone) {
  vk::PhysicalDeviceFeatures expected;
  expected.shaderFloat64 = VK_TRUE;
  EXPECT_EQ(pick_features(make_all_features(), {&kNeeded, 1}, "a device"), expected);
  EXPECT_EQ(pick_features(make_all_features(), {&kWelcome, 1}, "a device"), expected);
}

TEST(OptionalFeaturesTest, WhatIsNeededAndLackingIsOneError) {
  try {
    pick_features({}, {&kNeeded, 1}, "Little GPU");
    FAIL() << "nothing was thrown";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("Little GPU"), testing::HasSubstr("shaderFloat64"),
                                             testing::Not(testing::HasSubstr("\n"))));
  }
  EXPECT_EQ(pick_features({}, {&kWelcome, 1}, "Little GPU"), vk::PhysicalDeviceFeatures());
}

TEST(DeviceOptionsTest, ADeviceHasNothingOptionalUnlessItIsAskedFor) {
  const DeviceHandle device = open_device();
  EXPECT_EQ(device->enabled_features(), vk::PhysicalDeviceFeatures());
  EXPECT_FALSE(device->has_enabled(OptionalFeature::kFloat64));
  // Vulkan demands this one of who uses a layered driver.
  EXPECT_THAT(device->enabled_extensions(), testing::Each(testing::StrEq("VK_KHR_portability_subset")));
}

TEST(DeviceOptionsTest, ADeviceHasWhatIsAskedForWhereItOffersIt) {
  const DeviceHandle device = open_device(DeviceOptions{.features = {kWelcome}});
  EXPECT_EQ(device->has_enabled(OptionalFeature::kFloat64),
            has_feature(device->physical().getFeatures(), OptionalFeature::kFloat64));
  EXPECT_EQ(device->enabled_features().shaderInt64, VK_FALSE);
}

}  // namespace
}  // namespace promin::gpu
