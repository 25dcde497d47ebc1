// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/gltf/document.h"

namespace promin {

/// The compressed form of a buffer view (EXT_meshopt_compression, or KHR_meshopt_compression); null where it has none.
const nlohmann::json* find_meshopt(const nlohmann::json& view);

/// Checks what the extension says of each view: that its bytes lie in their buffer, and that mode, filter, stride and
/// count go together and are what the view says of the bytes that come out.
void check_gltf_meshopt(const nlohmann::json& document, LoadReport& report);

/// Decodes the compressed views among those that are needed, each into a buffer of its own, where the view then lies.
/// A stream that is broken, or far too short for what it promises, goes to the report.
void decode_gltf_meshopt(GltfDocument& document, const std::vector<bool>& is_needed_view, LoadReport& report);

}  // namespace promin
