// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/load_report.h"

namespace promin {

/// Refuses a document of another version than glTF 2, which the schema does not fit. One that names none is taken for
/// glTF 2.0, with a warning, unless it has the form of glTF 1.0.
void check_gltf_version(nlohmann::json& document, LoadReport& report);

/// Holds a parsed glTF document against the table of everything the loader reads: types, ranges, enumerations and
/// indices, so that no later step needs to ask. What breaks a rule is refused where it makes up the geometry, else
/// repaired (JsonCheck): a number is clamped, any other value is left out. Integers written as 3.0 become 3. Anything
/// else in the file is not looked at. Problems go to the report with their JSON path, e.g.
/// meshes[0].primitives[2].attributes.POSITION. Unless `is_strict`, accessors, buffer views and broken buffers that
/// nothing uses become null.
void check_gltf_schema(nlohmann::json& document, bool is_strict, LoadReport& report);

}  // namespace promin
