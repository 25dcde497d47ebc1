// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "formats/load_report.h"

namespace promin {

/// Deeper JSON is refused before a recursive parser sees it.
inline constexpr int kMaxJsonDepth = 200;

/// The JSON of a file, with the largest double in place of a number beyond it. Refuses, with the cure, and throws
/// InputError where it cannot be read.
nlohmann::json parse_json(std::string_view text, LoadReport& report, const std::string& cure);

}  // namespace promin
