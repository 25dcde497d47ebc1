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

/// Reads materials by name from the MTL files that an OBJ's mtllib lines name beside it. Missing files and what cannot
/// be shown (glass and shadows alone by illum, a map_Ka of its own, maps that parse_mtl ignores) are warned about.
std::map<std::string, MtlMaterial> read_mtl_files(const std::vector<std::string>& libraries, LoadReport& report);

/// Appends a material to the scene. Where it has Pr, Pm or their maps it is metallic-roughness, with the colour Kd.
/// Else it is Phong: Ka, Kd, Ks, Ns and Ke as they stand, with Ka as Kd where there is none; illum 0 shows Kd alone, 1
/// has no highlight, 2 has one, and from 3 on Ks also weighs the mirror ray. A map multiplies its colour, which is 1
/// where the file has none. What is not opaque by d, Tr or map_d blends.
void add_obj_material(const MtlMaterial& source, ObjTextures& textures, Scene& scene, LoadReport& report);

}  // namespace promin
