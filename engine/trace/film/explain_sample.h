// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "bvh/primitive_numbers.h"
#include "promin/explain.h"
#include "shared/layout.h"

namespace promin {

/// Converts a device's log of a sample to an ExplainedSample. `light_numbers` has the index in Scene::lights of each
/// light on the device.
ExplainedSample explain_sample(std::span<const layout::RayLog> log, const PrimitiveNumbers& numbers,
                               std::span<const uint32_t> light_numbers);

}  // namespace promin
