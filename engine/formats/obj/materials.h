// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// Reads materials by name from the MTL files that an OBJ's mtllib lines name beside it: Ka, Kd, Ks, Ns and Ke as they
/// stand, with Ka as Kd where there is none. illum 0 shows Kd alone, 1 has no highlight, 2 has one, and from 3 on Ks
/// also weighs the mirror ray. Missing files and what Phong cannot show (maps, transparency) are warned about.
std::map<std::string, Material> read_obj_materials(const std::vector<std::string>& libraries, LoadReport& report);

}  // namespace promin
