// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/textures.h"
#include "promin/scene.h"

namespace promin {

/// The materials of a document in file order: PROMIN_materials_phong, KHR_materials_unlit or metallic-roughness, each
/// as it is written, with its textures. Transparency is warned about by the material's name, extensions that are
/// not known elsewhere (extensions.h).
std::vector<Material> read_gltf_materials(const GltfDocument& document, GltfTextures& textures, LoadReport& report);

/// What a primitive without a material has: the specification's default material.
Material default_gltf_material();

}  // namespace promin
