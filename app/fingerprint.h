// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/device.h"

namespace promin::app {

/// The device and its driver, as pieces of jobs tell by what they were made.
std::string driver_of(const gpu::DeviceInfo& device);

/// SHA-256 over the device, its driver and its answers to fixed questions: hits of rays at every kind of primitive, and
/// a picture of both models of materials, lit and in shadow. Devices whose fingerprints differ may give
/// other bits, as one driver does on processors of two kinds; of devices with the same it is not to be expected.
/// Throws RunError.
std::string fingerprint_of(const gpu::Device& device);

}  // namespace promin::app
