// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "promin/display.h"
#include "promin/environment.h"
#include "promin/scene.h"

namespace promin::app {

// Writes scenes as JSON for programs (docs/usage.md, "Scenes as JSON"). Names are those of Python's dataclasses. Real
// numbers have the fewest digits that give the same bits, and null stands for infinite or missing values.

/// Returns the contents of a scene. Equal JSON means equal scenes, whether objects share geometry or not. Vertices and
/// texels are represented by hashes.
nlohmann::json json_of(const Scene& scene);
nlohmann::json json_of(const Environment& environment);
nlohmann::json json_of(const DisplayTransform& display);

/// Returns the text of a JSON file in UTF-8; bytes that are not UTF-8 become U+FFFD.
std::string write_json(const nlohmann::json& json);

}  // namespace promin::app
