// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// Returns the extensions of a document, and whether this loader models them. The extensions that the document lists
/// come first, in its order; unlisted extensions of materials and textures follow. Refuses a required unknown extension
/// if it applies to parts of geometry (a buffer, a buffer view, an accessor, a mesh primitive, a node), or if
/// `is_strict`. Every other extension that the loader ignores causes a warning with the number of materials or textures
/// that use it.
std::vector<FileExtension> check_gltf_extensions(const nlohmann::json& document, bool is_strict, LoadReport& report);

}  // namespace promin
