// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/load_report.h"

namespace promin {

/// Refuses a document of a version other than glTF 2, because it needs another schema. A document without a version is
/// read as glTF 2.0 with a warning, unless it has the form of glTF 1.0.
void check_gltf_version(nlohmann::json& document, LoadReport& report);

/// Checks a parsed glTF document against the table of everything that the loader reads: types, ranges, enumerations and
/// indices. Later steps need no checks of their own. A value that breaks a rule is refused if it is part of the
/// geometry, and repaired otherwise (JsonCheck): a number is clamped, any other value is removed. Integers written as
/// 3.0 become
/// 3. Other parts of the file are not checked. Problems go to the report with their JSON path, e.g.
/// meshes[0].primitives[2].attributes.POSITION. Unless `is_strict`, accessors, buffer views and broken buffers that
/// nothing uses become null.
void check_gltf_schema(nlohmann::json& document, bool is_strict, LoadReport& report);

}  // namespace promin
