// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "promin/motion.h"
#include "promin/scene.h"

namespace promin {

/// Returns the camera of a node with its link, if it has one. The camera is at the node's origin and looks along the
/// node's -Z; +Y is up. Scale is ignored, and the basis is made orthonormal in double. If a scale above the node is 0,
/// only the rotations determine the basis. A camera without a basis, or too far away, is left out with a warning.
std::optional<CameraLink> read_gltf_camera(const GltfDocument& document, const PlacedNode& placed, LoadReport& report);

}  // namespace promin
