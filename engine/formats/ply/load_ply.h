// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// Reads the report's file as PLY, text or binary in either byte order: the vertices' x, y, z, nx, ny, nz, colours,
/// which are assumed to be sRGB, and texture coordinates; the lists vertex_indices or vertex_index of faces, with
/// colours, texcoord and texnumber; and tristrips. The result is one object with the default material, or with one
/// material for each picture that a comment TextureFile names. Polygons of n corners give n - 2 triangles in file
/// order. Throws InputError with all problems.
Scene load_ply(const LoadOptions& options, LoadReport& report);

}  // namespace promin
