// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "promin/scene.h"

namespace promin {

/// The camera a node carries, if it does: at the node's origin, looking along its -Z with +Y up; scale is ignored and
/// the basis made orthonormal in double. A transform without a basis goes to the report.
std::optional<Camera> read_gltf_camera(const GltfDocument& document, const PlacedNode& placed, LoadReport& report);

}  // namespace promin
