// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "promin/shapes.h"

namespace promin {

/// Returns the triangles, in order, whose three vertex normals all point against the winding: each normal has an angle
/// of more than 90 degrees to the normal of the counterclockwise side. Empty for a mesh without normals. The mesh must
/// be valid.
std::vector<uint32_t> find_turned_triangles(const Mesh& mesh);

/// Negates normals and tangents of these triangles, so that the side to which their vertex normals point is shaded as a
/// front. The shading of a back negates them again. Other triangles keep their normals, so vertices that both kinds
/// share are split; the copies come after the old vertices. Positions and the order of triangles do not change. The
/// handedness of tangents follows the vertex normals, or with `tangents_follow_winding`, as for add_tangents, the
/// winding.
void turn_normals(Mesh& mesh, std::span<const uint32_t> turned, bool tangents_follow_winding);

}  // namespace promin
