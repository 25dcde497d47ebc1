// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "device/device.h"

namespace promin::test {

/// The default device. All suites of a process share it and the kernels that earlier suites compiled.
class SharedDevice : public testing::Environment {
 public:
  /// Returns the device, and opens it if no earlier suite has done so.
  static const gpu::Device& open(const gpu::DeviceOptions& options) {
    if (!device_) device_ = gpu::open_device(options);
    return *device_;
  }
  /// Closes the device after the last test, before the driver's libraries end.
  void TearDown() override { device_.reset(); }

 private:
  static inline gpu::DeviceHandle device_;
};
inline testing::Environment* const kSharedDevice = testing::AddGlobalTestEnvironment(new SharedDevice);

/// Gives a test the shared device, and fails the test if the validation layers report something during it. Pictures are
/// traced by single pixels, whose kernels compile faster. Packets give the same bits, as the goldens and the tests of
/// packets check.
class DeviceTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { open({.pixel_packet_size = 1}); }

  void SetUp() override { messages_before_ = gpu::validation_message_count(device()); }
  void TearDown() override {
    EXPECT_EQ(gpu::validation_message_count(device()), messages_before_) << "the validation layers spoke";
  }

  static void open(const gpu::DeviceOptions& options) { device_ = &SharedDevice::open(options); }
  static const gpu::Device& device() { return *device_; }

 private:
  static inline const gpu::Device* device_ = nullptr;
  uint64_t messages_before_ = 0;
};

}  // namespace promin::test
