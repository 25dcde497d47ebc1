// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "promin/math.h"

namespace promin {

// Access functions for a glTF document that follows the schema (schema.h).

/// Returns the array `name` of an object; an empty array if there is none.
const nlohmann::json& elements_of(const nlohmann::json& object, const char* name);

/// Returns the extension `name` of an element, or null.
const nlohmann::json* find_extension(const nlohmann::json& element, const char* name);

dvec3 vec3_of(const nlohmann::json& object, const char* name, const dvec3& otherwise);
dvec4 vec4_of(const nlohmann::json& object, const char* name, const dvec4& otherwise);

/// Returns the title of an element in warnings: its name in quotes, or its place ("materials[3]").
std::string title_of(const nlohmann::json& document, const char* array, size_t index);

}  // namespace promin
