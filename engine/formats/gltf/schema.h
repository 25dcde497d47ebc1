// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/load_report.h"

namespace promin {

/// Holds a parsed glTF document against the table of everything the loader reads: types, ranges, enumerations and
/// indices, so that no later step needs to ask. Integers written as 3.0 become 3. Anything else in the file is not
/// looked at. Problems go to the report with their JSON path, e.g. meshes[0].primitives[2].attributes.POSITION.
void check_gltf_schema(nlohmann::json& document, LoadReport& report);

}  // namespace promin
