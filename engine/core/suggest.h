// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace promin {

/// Returns the known name nearest to a mistyped name, or an empty view if none is near. A name is near if at most a
/// third of the typed letters (at least one) must be inserted, deleted, replaced or swapped. Upper and lower case are
/// equal.
std::string_view nearest_name(std::string_view typed, std::span<const std::string_view> known);

/// Returns the advice for an unknown name: `did you mean "sah"? Known: sah, median`, or `known: sah, median` if no name
/// is near.
std::string suggest_name(std::string_view typed, std::span<const std::string_view> known);

/// Lists the names for a sentence: "sah, median or spatial".
std::string list_choices(std::span<const std::string_view> names);

}  // namespace promin
