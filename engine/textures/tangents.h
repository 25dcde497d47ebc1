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
/// corner. Flat normals take the place of missing ones. A corner whose triangle has no handedness takes a tangent that
/// its vertex has, else one of no length. Where no triangle has any, the mesh stays as it is.
///
/// A vertex whose corners differ is split; copies come after the old vertices, positions keep their bits, triangles
/// their number and order. The result is the same for any number of threads. Beside the mesh it takes about 100 bytes a
/// triangle.
void add_tangents(Mesh& mesh, uint32_t uv_set);

}  // namespace promin
