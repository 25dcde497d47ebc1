// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "promin/motion.h"
#include "promin/scene.h"
#include "promin/shapes.h"

namespace promin {

/// The parts of a mesh primitive to read in addition to its triangles.
struct GltfMeshNeeds {
  /// True if the morph targets are needed.
  bool targets = false;
  /// The number of joints of the mesh's skin; 0 if joints and weights of the vertices are not needed.
  size_t joint_count = 0;

  auto operator<=>(const GltfMeshNeeds&) const = default;
};

/// Returns a mesh primitive's triangles (modes 4, 5, 6; glTF 2.0, section 3.7.2) in the mesh's own space. The mesh has
/// only the vertices that the triangles use. For points, lines and primitives without a triangle the function returns
/// an empty mesh and adds a warning. The report receives wrong indices and coordinates.
///
/// A morph target of a wrong size has no displacements. A vertex without weights follows the first joint that it names.
/// A primitive without joints has no influences. All these cases are reported. The report receives joints that the skin
/// does not have.
DeformingMesh read_gltf_mesh(const GltfDocument& document, size_t mesh, size_t primitive, const GltfMeshNeeds& needs,
                             LoadReport& report);

/// Warns of normals that vanish.
void warn_of_normals(const std::string& place, LoadReport& report);

/// Returns an upper bound for the number of a primitive's triangles, which is known before data is read.
uint64_t count_gltf_triangles(const GltfDocument& document, size_t mesh, size_t primitive);

/// Adds the object that shows a mesh at a node. Its geometry is the mesh at `geometry`. If the node's transform is
/// singular, it is a new mesh to which the transform is already applied, without normals if they vanish. Reports a
/// vertex beyond 1e15 in the world. `box` has the bounds of the mesh's positions, and `place` names the primitive.
void place_gltf_mesh(const PlacedNode& placed, uint32_t geometry, const Bounds& box, const std::string& place,
                     Scene& scene, Object& object, LoadReport& report);

}  // namespace promin
