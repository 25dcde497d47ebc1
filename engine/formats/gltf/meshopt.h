// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/gltf/document.h"

namespace promin {

/// Returns the compressed form of a buffer view (EXT_meshopt_compression or KHR_meshopt_compression), or null.
const nlohmann::json* find_meshopt(const nlohmann::json& view);

/// Checks the extension's data of each view. The compressed bytes must lie in their buffer. Mode, filter, stride and
/// count must agree with each other and with the view.
void check_gltf_meshopt(const nlohmann::json& document, LoadReport& report);

/// Decodes the compressed views that are needed. Each is decoded into a new buffer, to which the view then refers.
/// Reports a stream that is damaged or far too short for its count.
void decode_gltf_meshopt(GltfDocument& document, const std::vector<bool>& is_needed_view, LoadReport& report);

}  // namespace promin
