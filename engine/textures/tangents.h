// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "promin/shapes.h"

namespace promin {

/// Gives a valid mesh with texture coordinates the tangents of set `uv_set` that baking tools compute (Mikkelsen,
/// "Simulation of Wrinkled Surfaces Revisited", 2008, with v growing upwards, as glTF 2.0, section 3.7.2.1, asks for).
/// Corners with equal position, normal and coordinates are one vertex. Around it, triangles that share an edge and the
/// handedness of their coordinates have one tangent: the mean of theirs across the normal, weighted by the angle at the
/// corner. Flat normals take the place of missing ones. A triangle whose coordinates have no area, or of which one
/// grows nowhere, has no handedness: its corners take the tangents of the groups that come to them, else the first that
/// their vertex has, else one of no length. Those of a degenerate triangle take the first, whatever the hands of the
/// others. Where no triangle has any, the mesh stays as it is.
///
/// Of more than two triangles at an edge the first that runs one way goes with the first that runs the other way, and
/// so on. Mikkelsen's program does so, too, but for edges whose lower vertex is the highest of all: these it leaves
/// unsorted, so what of them it joins depends on the numbers of their vertices.
///
/// A vertex whose corners differ is split; copies come after the old vertices, positions keep their bits, triangles
/// their number and order. The result is the same for any number of threads. Beside the mesh it takes about 100 bytes a
/// triangle.
void add_tangents(Mesh& mesh, uint32_t uv_set);

}  // namespace promin
