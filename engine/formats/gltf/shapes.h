// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "promin/scene.h"

namespace promin {

/// Returns the analytic shape of KHR_implicit_shapes that a mesh primitive represents
/// (PROMIN_mesh_primitive_implicit_shape), in its own space. Returns nullopt if there is no such shape. Also returns
/// nullopt, with a warning, if the shape cannot be drawn exactly. The primitive's triangles are then drawn. The report
/// receives wrong sizes.
std::optional<Geometry> read_gltf_shape(const GltfDocument& document, size_t mesh, size_t primitive,
                                        const PlacedNode& placed, LoadReport& report);

}  // namespace promin
