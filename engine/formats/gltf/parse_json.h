// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "formats/load_report.h"

namespace promin {

/// The largest depth of nesting. Deeper JSON is refused before the recursive parser runs.
inline constexpr int kMaxJsonDepth = 200;

/// Parses the JSON of a file; numbers beyond the range of double become the largest double. Throws InputError, with
/// advice, if the text cannot be parsed.
nlohmann::json parse_json(std::string_view text, LoadReport& report, const std::string& cure);

}  // namespace promin
