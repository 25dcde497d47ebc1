// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/gltf/document.h"

namespace promin {

/// The compressed form of a mesh primitive (KHR_draco_mesh_compression); null where it has none.
const nlohmann::json* find_draco(const nlohmann::json& primitive);

/// Decodes the compressed mesh primitives of a document on all cores, and gives each accessors of its own, over buffers
/// of their own. A stream that is broken, or holds other numbers of triangles or vertices than the primitive's
/// accessors say, goes to the report; what its header promises is held against these before memory is taken for it.
void decode_gltf_draco(GltfDocument& document, LoadReport& report);

}  // namespace promin
