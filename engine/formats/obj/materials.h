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

/// Reads the MTL files that the mtllib lines of an OBJ file name, and returns their materials by name. Warns of missing
/// files and of features that are not supported (glass and shadow-only materials by illum, a separate map_Ka, maps that
/// parse_mtl ignores).
std::map<std::string, MtlMaterial> read_mtl_files(const std::vector<std::string>& libraries, LoadReport& report);

/// Appends a material to the scene. With Pr, Pm or their maps it is a metallic-roughness material with the colour Kd.
/// Otherwise it is a Phong material with Ka, Kd, Ks, Ns and Ke as written; the default of Ka is Kd. With illum 0 only
/// Kd is visible; illum 1 has no highlight, illum 2 has one, and from illum 3 on Ks is also the factor of the mirror
/// ray. A map multiplies its colour, which defaults to 1. A material that is transparent according to d, Tr or map_d
/// blends.
void add_obj_material(const MtlMaterial& source, ObjTextures& textures, Scene& scene, LoadReport& report);

}  // namespace promin
