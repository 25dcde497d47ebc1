// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "promin/shapes.h"

namespace promin {

/// The triangles, in order, whose three vertex normals all lie against their winding: each has an angle of more than 90
/// degrees with the normal of the counter-clockwise side. None of a mesh without normals. The mesh is valid.
std::vector<uint32_t> find_turned_triangles(const Mesh& mesh);

/// Gives these triangles of a mesh the normals and tangents that shade the side which their vertex normals face as a
/// front: both are negated, as a back negates them once more. Other triangles keep theirs, so vertices which both kinds
/// share are split; the copies come after the old vertices. Positions and the order of triangles do not change. The
/// handedness of tangents is that of the vertex normals, or where `tangents_follow_winding`, as those of add_tangents
/// do, that of the winding.
void turn_normals(Mesh& mesh, std::span<const uint32_t> turned, bool tangents_follow_winding);

}  // namespace promin
