// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "promin/scene.h"

namespace promin {

/// The camera a node carries, if it does: at the node's origin, looking along its -Z with +Y up; scale is ignored and
/// the basis made orthonormal in double. Below a scale of 0 the rotations alone give the basis. A camera without one,
/// or too far away, is left out with a warning.
std::optional<Camera> read_gltf_camera(const GltfDocument& document, const PlacedNode& placed, LoadReport& report);

}  // namespace promin
