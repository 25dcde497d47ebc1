// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace promin {

/// Replacements for any value of a glTF document: each kind of value, and numbers and words that have a meaning
/// elsewhere.
inline const nlohmann::json kOtherValues = nlohmann::json::parse(
    R"([null, true, -1, 0, 1, 7, 12, 1.5, 1e300, 2147483647, 18446744073709551615, "", "x", "TRIANGLES", [], {}])");

}  // namespace promin
