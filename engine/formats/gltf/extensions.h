// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// The extensions that a document names or carries, as far as this loader models them: those that it lists in its
/// order, then those that lie on materials and textures without being listed. Refuses a required extension that is not
/// known where it lies on what geometry is made of (a buffer, a buffer view, an accessor, a mesh primitive, a node), or
/// where `is_strict`, in any case. What else is left out is a warning for each extension, with the number of materials
/// or textures.
std::vector<FileExtension> check_gltf_extensions(const nlohmann::json& document, bool is_strict, LoadReport& report);

}  // namespace promin
