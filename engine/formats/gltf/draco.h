// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/gltf/document.h"

namespace promin {

/// Returns the compressed form of a mesh primitive (KHR_draco_mesh_compression), or null.
const nlohmann::json* find_draco(const nlohmann::json& primitive);

/// Decodes the compressed mesh primitives of a document on all cores, and gives each its own accessors and buffers.
/// Reports a stream that is damaged, or whose numbers of triangles or vertices differ from those of the primitive's
/// accessors. The numbers in its header are checked before memory is allocated for them.
void decode_gltf_draco(GltfDocument& document, LoadReport& report);

}  // namespace promin
