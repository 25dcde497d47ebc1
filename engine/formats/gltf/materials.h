// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/gltf/document.h"
#include "promin/scene.h"

namespace promin {

/// The materials of a document in file order. PROMIN_materials_phong is taken as it is; a metallic-roughness material
/// becomes the Phong material that comes near it; KHR_materials_unlit becomes a source of its base colour. What Phong
/// cannot show (textures, transparency, other extensions) is warned about by the material's name.
std::vector<Material> read_gltf_materials(const GltfDocument& document, LoadReport& report);

/// What a primitive without a material has: the specification's default material.
Material default_gltf_material();

}  // namespace promin
