// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/device.h"

namespace promin::work {

/// Returns the name of the device and its driver, as pieces of jobs record it.
std::string driver_of(const gpu::DeviceInfo& device);

/// Returns SHA-256 over the device, its driver and its results for a fixed test: hits of rays at every kind of
/// primitive, and a picture of both material models, lit and in shadow. Devices with different fingerprints may give
/// different bits; the same driver gives different bits on two types of processors. Devices with the same fingerprint
/// are expected to give the same bits. Throws RunError.
std::string fingerprint_of(const gpu::Device& device);

}  // namespace promin::work
