// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/load_report.h"
#include "promin/math.h"

namespace promin {

/// Facets under one name.
struct StlSolid {
  std::string name = {};
  /// Three corners for each facet; each coordinate is at most 1e15.
  std::vector<vec3> corners = {};
  /// Empty, or a linear colour for each facet, within 0...1.
  std::vector<vec3> colors = {};
};

/// Whether a word is the keyword, which is in lower case; in the file it may have any.
bool is_stl_keyword(std::string_view word, std::string_view keyword);

/// Parses an STL file that is text, whose lines mean nothing but that the name of a solid ends with its line. Facets
/// without a place are left out, and those of more than three corners cut in triangles. Problems go to the report with
/// their line.
std::vector<StlSolid> parse_stl_text(std::string_view text, LoadReport& report);

}  // namespace promin
