// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "formats/gltf/document.h"

namespace promin {

/// Returns the elements of an accessor as fp32, component after component. Normalized integers are mapped to [0, 1] or
/// [-1, 1] (glTF 2.0, section 3.11), sparse elements are applied, and an accessor without a buffer view is all zeros.
/// Adds a problem for a sparse index out of range.
std::vector<float> read_floats(const GltfDocument& document, int accessor, LoadReport& report);

/// The elements of an unsigned integer accessor.
std::vector<uint32_t> read_indices(const GltfDocument& document, int accessor, LoadReport& report);

}  // namespace promin
