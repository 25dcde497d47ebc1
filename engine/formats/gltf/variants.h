// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "formats/gltf/document.h"

namespace promin {

/// Returns the names of a document's material variants, in its order (KHR_materials_variants).
std::vector<std::string> list_gltf_variants(const nlohmann::json& document);

/// Sets the materials of mesh primitives to those of the variant with this name; if several have the name, the first
/// counts. A primitive without a mapping for the variant keeps its material. Throws UsageError with the existing names
/// if `file` has no such variant.
void choose_gltf_variant(GltfDocument& document, const std::string& name, const std::filesystem::path& file);

}  // namespace promin
