// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "promin/explain.h"
#include "promin/scene.h"

namespace promin::app {

// Functions that format a pixel's ray tree for people and programs. The scene is the rendered one, including added
// lights.

/// Returns the JSON that docs/explain.md describes. Its numbers can be read back with the same bits.
std::string explain_json(const Explanation& explanation, const Scene& scene);

/// Returns a line for each ray and each source, indented under the ray that leads to it.
std::string explain_text(const Explanation& explanation, const Scene& scene);

}  // namespace promin::app
