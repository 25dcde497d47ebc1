// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace promin {

/// Returns a count with its noun: "1 pixel", "2 pixels".
inline std::string count_of(uint64_t count, std::string_view noun) {
  return std::to_string(count).append(" ").append(noun).append(count == 1 ? "" : "s");
}

/// Returns the verb for a count: "1 pixel differs", "2 pixels differ".
inline std::string_view verb_of(uint64_t count, std::string_view of_one, std::string_view of_several) {
  return count == 1 ? of_one : of_several;
}

}  // namespace promin
