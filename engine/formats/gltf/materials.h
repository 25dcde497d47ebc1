// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/textures.h"
#include "promin/scene.h"

namespace promin {

/// Returns the materials of a document in file order, with their textures and alpha. The models are
/// PROMIN_materials_phong, KHR_materials_unlit and metallic-roughness. KHR_materials_pbrSpecularGlossiness is converted
/// to an equivalent metallic-roughness material. Warns with the material's name if a Phong material has textures or an
/// alphaMode, which are ignored. extensions.h warns of unknown extensions.
std::vector<Material> read_gltf_materials(const GltfDocument& document, GltfTextures& textures, LoadReport& report);

/// Returns the specification's default material, for primitives without a material.
Material default_gltf_material();

}  // namespace promin
