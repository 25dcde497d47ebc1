// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "scene/shapes.h"

namespace promin {

/// A mesh primitive's triangles (modes 4, 5, 6; glTF 2.0, section 3.7.2) in world space, with the vertices they use
/// alone. Under a mirroring transform corners 2 and 3 change places, so that counter-clockwise stays outside.
/// Points, lines and primitives without a triangle come back empty, with a warning; bad indices and coordinates go to
/// the report.
Mesh read_gltf_mesh(const GltfDocument& document, size_t mesh, size_t primitive, const PlacedNode& placed,
                    LoadReport& report);

}  // namespace promin
