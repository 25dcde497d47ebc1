// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"

namespace promin {

/// How often a node shows its mesh (EXT_mesh_gpu_instancing); nullopt where the node is shown once, as it is.
std::optional<uint64_t> count_gltf_instances(const GltfDocument& document, const PlacedNode& placed);

/// The places in the world of a node with instances, in their order: the node's transform times that of each. Numbers
/// that are not finite go to the report; a rotation without length turns nothing, with a warning.
std::vector<dmat4> place_gltf_instances(const GltfDocument& document, const PlacedNode& placed, LoadReport& report);

}  // namespace promin
