// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "formats/gltf/document.h"

namespace promin {

/// Returns the elements of an accessor as fp32, component after component. The function maps normalized integers to [0,
/// 1] or [-1, 1] (glTF 2.0, section 3.11) and applies sparse elements. An accessor without a buffer view contains
/// zeros. Adds a problem for a sparse index out of range.
std::vector<float> read_floats(const GltfDocument& document, int accessor, LoadReport& report);

/// Returns the same numbers in double, in which integers are converted.
std::vector<double> read_doubles(const GltfDocument& document, int accessor, LoadReport& report);

/// Returns the elements of an accessor of unsigned integers.
std::vector<uint32_t> read_indices(const GltfDocument& document, int accessor, LoadReport& report);

}  // namespace promin
