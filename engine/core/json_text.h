// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

// The library's parser and writer of JSON, compiled once for all files that use them.
namespace promin {

/// Returns the value as text, on one line if `indent` is negative, else with `indent` spaces for each level. Bytes that
/// are not UTF-8 are replaced.
std::string json_text(const nlohmann::json& value, int indent = -1);
std::string json_text(const nlohmann::ordered_json& value, int indent = -1);

/// Throws nlohmann::json::exception.
nlohmann::json read_json(std::string_view text);
nlohmann::ordered_json read_ordered_json(std::string_view text);
/// Returns a discarded value if the text is not JSON.
nlohmann::ordered_json read_ordered_json_or_discard(std::string_view text);

}  // namespace promin
