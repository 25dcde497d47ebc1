// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// Reads the report's file as PLY, text or binary in either byte order. It reads the vertices' x, y, z, nx, ny, nz,
/// colours (assumed to be sRGB) and texture coordinates. It reads the faces' list vertex_indices or vertex_index,
/// colours, texcoord and texnumber. It also reads tristrips. The result is one object with the default material, or
/// with one material for each picture that a comment TextureFile names. Polygons of n corners give n - 2 triangles in
/// file order. Throws InputError with all problems.
Scene load_ply(const LoadOptions& options, LoadReport& report);

}  // namespace promin
