// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "formats/gltf/document.h"

namespace promin {

/// The names of the variants of a document's materials, in its order (KHR_materials_variants).
std::vector<std::string> list_gltf_variants(const nlohmann::json& document);

/// Gives the mesh primitives of a document the materials that they have in the variant of this name, the first of
/// several; those that it says nothing of keep theirs. Throws UsageError, with the names that there are, where there is
/// no such variant in `file`.
void choose_gltf_variant(GltfDocument& document, const std::string& name, const std::filesystem::path& file);

}  // namespace promin
