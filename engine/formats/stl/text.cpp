// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/stl/text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "formats/text_lines.h"
#include "promin/validate.h"

namespace promin {
namespace {

class StlParser {
 public:
  StlParser(std::string_view text, LoadReport& report) : lines_(text), report_(report) {}

  std::vector<StlSolid> parse() {
    while (lines_.advance()) {
      std::string_view line = lines_.line();
      const std::string_view keyword = take_word(line);
      if (!keyword.empty()) read_statement(keyword, line);
    }
    if (is_in_facet_) report_.refuse("the file ends within a facet", lines_.place(), "export the file again");
    if (ignored_count_ > 0) {
      report_.warn(std::to_string(ignored_count_) + " statements of STL are ignored, the first is " + first_ignored_);
    }
    return std::move(solids_);
  }

 private:
  void refuse(const std::string& what, const std::string& cure) { report_.refuse(what, lines_.place(), cure); }

  /// Ordered by how often they come.
  void read_statement(std::string_view keyword, std::string_view rest) {
    if (is_stl_keyword(keyword, "vertex")) {
      read_vertex(rest);
    } else if (is_stl_keyword(keyword, "facet")) {
      begin_facet();
    } else if (is_stl_keyword(keyword, "endfacet")) {
      end_facet();
    } else if (is_stl_keyword(keyword, "solid")) {
      solids_.push_back({.name = std::string(trim(rest))});
    } else if (!is_stl_keyword(keyword, "outer") && !is_stl_keyword(keyword, "endloop") &&
               !is_stl_keyword(keyword, "endsolid") && ignored_count_++ == 0) {
      first_ignored_ = quote(keyword) + " in " + lines_.place();
    }
  }

  void begin_facet() {
    if (is_in_facet_) refuse("a facet begins within another", "export the file again");
    if (solids_.empty()) solids_.emplace_back();
    is_in_facet_ = true;
    corner_count_ = 0;
  }

  void read_vertex(std::string_view rest) {
    if (!is_in_facet_) return refuse("a vertex lies in no facet", "export the file again");
    vec3 corner;
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = take_word(rest);
      const std::optional<double> number = parse_number(word);
      if (!number || std::abs(*number) > kMaxCoordinate) {
        return refuse(quote(word) + " is no number up to 1e15", "give each vertex x y z");
      }
      corner[i] = static_cast<float>(*number - report_.center()[i]);
    }
    ++corner_count_;
    solids_.back().corners.push_back(corner);
  }

  void end_facet() {
    if (!is_in_facet_) return refuse("the end of a facet has no begin", "export the file again");
    is_in_facet_ = false;
    if (corner_count_ != 3) {
      refuse("a facet has " + std::to_string(corner_count_) + " corners", "give it 3");
    }
  }

  TextLines lines_;
  LoadReport& report_;
  std::vector<StlSolid> solids_;
  bool is_in_facet_ = false;
  uint64_t corner_count_ = 0;
  uint64_t ignored_count_ = 0;
  std::string first_ignored_;
};

}  // namespace

bool is_stl_keyword(std::string_view word, std::string_view keyword) {
  return std::ranges::equal(word, keyword, [](char a, char b) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(a))) == b;
  });
}

std::vector<StlSolid> parse_stl_text(std::string_view text, LoadReport& report) {
  return StlParser(text, report).parse();
}

}  // namespace promin
