// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// Returns the extensions of a document, with whether this loader models them: first those that it lists, in its order,
/// then unlisted ones of materials and textures. Refuses a required unknown extension if it applies to parts of
/// geometry (a buffer, a buffer view, an accessor, a mesh primitive, a node), or if `is_strict`. Each other ignored
/// extension causes a warning with the number of materials or textures.
std::vector<FileExtension> check_gltf_extensions(const nlohmann::json& document, bool is_strict, LoadReport& report);

}  // namespace promin
