// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace promin {

/// The known name nearest to a mistyped one, or an empty view if none is near: at most a third of the typed letters
/// (one at least) inserted, deleted or replaced (Levenshtein's distance), regardless of case.
std::string_view nearest_name(std::string_view typed, std::span<const std::string_view> known);

/// The cure for an unknown name: `did you mean "sah"? Known: sah, median`, or `known: sah, median` where none is near.
std::string suggest_name(std::string_view typed, std::span<const std::string_view> known);

/// Lists the names for a sentence: "sah, median or spatial".
std::string list_choices(std::span<const std::string_view> names);

}  // namespace promin
