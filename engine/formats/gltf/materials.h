// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/textures.h"
#include "promin/scene.h"

namespace promin {

/// The materials of a document in file order, each with its textures and its alpha: PROMIN_materials_phong,
/// KHR_materials_unlit or metallic-roughness as it is written, KHR_materials_pbrSpecularGlossiness as the
/// metallic-roughness that is the same. What a Phong material leaves out, textures and alphaMode, is warned about by
/// the material's name, extensions that are not known elsewhere (extensions.h).
std::vector<Material> read_gltf_materials(const GltfDocument& document, GltfTextures& textures, LoadReport& report);

/// What a primitive without a material has: the specification's default material.
Material default_gltf_material();

}  // namespace promin
