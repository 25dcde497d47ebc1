// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "formats/gltf/skins.h"
#include "promin/scene.h"
#include "promin/shapes.h"

namespace promin {

/// A mesh primitive's triangles (modes 4, 5, 6; glTF 2.0, section 3.7.2) in the mesh's own space, with the vertices
/// they use alone, moved by the morph targets that have weights other than 0. Points, lines and primitives without a
/// triangle come back empty, with a warning; bad indices and coordinates go to the report.
///
/// Where there is a `pose`, the joints of the vertices place them in the world. A vertex without weights goes with the
/// first joint that it names, and a primitive without joints stands as it is; both are repaired.
Mesh read_gltf_mesh(const GltfDocument& document, size_t mesh, size_t primitive, const std::vector<double>& weights,
                    const GltfPose* pose, LoadReport& report);

/// Number of these triangles, as far as the file tells before anything is read.
uint64_t count_gltf_triangles(const GltfDocument& document, size_t mesh, size_t primitive);

/// The object that shows a mesh at a node: its geometry is the mesh at `geometry`, or where the node's transform is
/// singular a new one that is flattened already, without normals if these vanish. A vertex beyond 1e15 in the world
/// goes to the report. `place` names the primitive.
void place_gltf_mesh(const PlacedNode& placed, uint32_t geometry, const std::string& place, Scene& scene,
                     Object& object, LoadReport& report);

}  // namespace promin
