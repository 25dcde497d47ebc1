// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"

namespace promin {

/// Returns the number of instances of a node's mesh (EXT_mesh_gpu_instancing); nullopt for a node without the
/// extension.
std::optional<uint64_t> count_gltf_instances(const GltfDocument& document, const PlacedNode& placed);

/// Returns the transforms from a node's instances to the node, in their order. Reports numbers that are not finite. A
/// rotation of length 0 is ignored with a warning.
std::vector<dmat4> place_gltf_instances(const GltfDocument& document, const PlacedNode& placed, LoadReport& report);

}  // namespace promin
