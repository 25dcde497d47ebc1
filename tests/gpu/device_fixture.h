// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "device/device.h"

namespace promin::test {

/// Opens the default device once for a suite; a test fails if the validation layers spoke during it. Pictures are
/// traced by single pixels, whose kernels compile sooner. Packets give the same bits: the goldens and the tests of
/// packets hold that.
class DeviceTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { open({.pixel_packet_size = 1}); }
  static void TearDownTestSuite() { device_.reset(); }

  void SetUp() override { messages_before_ = gpu::validation_message_count(*device_); }
  void TearDown() override {
    EXPECT_EQ(gpu::validation_message_count(*device_), messages_before_) << "the validation layers spoke";
  }

  static void open(const gpu::DeviceOptions& options) { device_ = gpu::open_device(options); }
  static const gpu::Device& device() { return *device_; }

 private:
  static inline gpu::DeviceHandle device_;
  uint64_t messages_before_ = 0;
};

}  // namespace promin::test
