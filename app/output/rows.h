// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/utf8.h"

namespace promin::app {

/// Prints a line of an info command on the standard output.
inline void print_row(const std::string& name, const std::string& value) {
  fmt::print("{:<12}{}\n", name, to_one_line(value));
}

/// Prints each of `values` on a line. The first line has the name.
inline void print_rows(const std::string& name, const std::vector<std::string>& values) {
  for (size_t i = 0; i < values.size(); ++i) print_row(i == 0 ? name : "", values[i]);
}

}  // namespace promin::app
