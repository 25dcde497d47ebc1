// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "support/gltf_builder.h"

namespace promin::test {

/// A point in long double.
using OraclePoint = std::array<long double, 3>;

/// An independent reference for poses, written from the glTF 2.0 specification. It shares no code with the engine.
///
/// Returns the world positions of the corners of all triangles of each object at a time, in the order of objects: depth
/// first by node, then by primitive. A hidden object has no corners. `clips` are the animations to show; the first one
/// that changes a property counts. Meshes have indices and mode 4.
std::vector<std::vector<OraclePoint>> pose_by_specification(const GltfBuilder& gltf, const std::vector<size_t>& clips,
                                                            long double time_s);

}  // namespace promin::test
