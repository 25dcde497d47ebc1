// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"
#include "promin/shapes.h"

namespace promin {

/// Returns the bounds of all positions of a mesh.
Bounds bounds_of_positions(const Mesh& mesh);

/// Returns whether all vertices of a mesh lie within 1e15 in the world. `box` is bounds_of_positions(mesh).
bool is_mesh_in_range(const Mesh& mesh, const Bounds& box, const dmat4& world_from_object);

/// Returns whether a transform is almost singular or overflows, so that an object cannot have it, because normals may
/// vanish.
bool is_singular(const dmat4& world_from_object);

/// Returns a mesh to which a singular transform is applied, without normals if they vanish. Then `has_lost_normals`
/// becomes true.
Mesh apply_transform(Mesh mesh, const dmat4& world_from_object, bool& has_lost_normals);

/// Returns whether an analytic shape keeps its form under a transform, and its sizes and position are in range. A mesh
/// always does.
bool keeps_form(const Geometry& geometry, const dmat4& world_from_object);

}  // namespace promin
