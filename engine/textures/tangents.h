// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "promin/shapes.h"

namespace promin {

/// Gives a valid mesh with texture coordinates the tangents of set `uv_set` that baking tools compute (Mikkelsen,
/// "Simulation of Wrinkled Surfaces Revisited", 2008, with v increasing upwards, as glTF 2.0, section 3.7.2.1,
/// requires). Corners with equal position, normal and coordinates are one vertex. Around a vertex, triangles that share
/// an edge and have the same handedness of coordinates share one tangent. It is the mean of their tangents
/// perpendicular to the normal, weighted by the angle at the corner. Flat normals replace missing ones. A triangle
/// whose coordinates have no area, or one of whose coordinates is constant, has no handedness. Its corners get the
/// tangents of adjoining groups; if there are none, the first tangent of their vertex; and if there is none, a zero
/// vector. Corners of a degenerate triangle get the first tangent of any handedness. If no triangle has a tangent, the
/// mesh does not change.
///
/// If more than two triangles share an edge, the first in one direction is paired with the first in the other
/// direction, and so on. Mikkelsen's program does the same except for edges whose lower vertex is the highest of all:
/// it leaves these edges unsorted, so its pairs depend on the numbers of their vertices.
///
/// A vertex whose corners have different tangents is split. Copies come after the old vertices. Positions keep their
/// bits, and triangles keep their number and order. The result is the same for every number of threads. In addition to
/// the mesh, the function needs about 100 bytes per triangle.
void add_tangents(Mesh& mesh, uint32_t uv_set);

}  // namespace promin
