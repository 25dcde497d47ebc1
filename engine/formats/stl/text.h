// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/load_report.h"
#include "promin/math.h"

namespace promin {

/// The facets of one solid.
struct StlSolid {
  std::string name = {};
  /// Three corners for each facet; each coordinate is at most 1e15.
  std::vector<vec3> corners = {};
  /// Colours of the facets, linear, within 0...1: empty, or one for each facet.
  std::vector<vec3> colors = {};
};

/// Returns whether a word is the keyword. `keyword` is in lower case; the word may be in any case.
bool is_stl_keyword(std::string_view word, std::string_view keyword);

/// Parses a text STL file. Line ends matter only after the name of a solid. Facets with invalid positions are left out.
/// Facets with more than three corners are divided into triangles. The report receives problems with their line.
std::vector<StlSolid> parse_stl_text(std::string_view text, LoadReport& report);

}  // namespace promin
