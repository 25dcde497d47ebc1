// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "formats/load_report.h"
#include "formats/obj/mtl.h"
#include "formats/obj/textures.h"
#include "promin/scene.h"

namespace promin {

/// Reads materials by name from the MTL files that the mtllib lines of an OBJ file name. Warns of missing files and of
/// features that are not supported (glass and shadow-only materials by illum, a separate map_Ka, maps that parse_mtl
/// ignores).
std::map<std::string, MtlMaterial> read_mtl_files(const std::vector<std::string>& libraries, LoadReport& report);

/// Appends a material to the scene. With Pr, Pm or their maps it is metallic-roughness with the colour Kd. Else it is
/// Phong with Ka, Kd, Ks, Ns and Ke as written; Ka defaults to Kd. illum 0 shows only Kd, 1 has no highlight, 2 has
/// one, and from 3 on Ks also weights the mirror ray. A map multiplies its colour, which defaults to 1. A material that
/// is not opaque by d, Tr or map_d blends.
void add_obj_material(const MtlMaterial& source, ObjTextures& textures, Scene& scene, LoadReport& report);

}  // namespace promin
