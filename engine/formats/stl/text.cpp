// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/stl/text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "formats/text_lines.h"
#include "formats/text_words.h"
#include "formats/triangulate.h"
#include "promin/validate.h"

namespace promin {
namespace {

/// Returns the text after "solid" up to the beginning of the first facet or of the end statement, which may be on the
/// same line.
std::string_view name_in(std::string_view behind) {
  std::string_view rest = behind;
  for (std::string_view word = take_field(rest); !word.empty(); word = take_field(rest)) {
    std::string_view behind_word = rest;
    const std::string_view next = take_field(behind_word);
    const bool is_facet =
        is_stl_keyword(word, "facet") &&
        (is_stl_keyword(next, "normal") || is_stl_keyword(next, "outer") || is_stl_keyword(next, "vertex"));
    if (is_facet || is_stl_keyword(word, "endsolid")) {
      return behind.substr(0, static_cast<size_t>(word.data() - behind.data()));
    }
  }
  return behind;
}

class StlParser {
 public:
  StlParser(std::string_view text, LoadReport& report) : words_(text), report_(report) {}

  std::vector<StlSolid> parse() {
    while (!words_.next().empty()) read_statement(words_.take());
    if (is_in_facet_)
      report_.refuse("stl.file.short", "the file ends within a facet", words_.place(), "export the file again");
    if (ignored_count_ > 0) {
      report_.warn(std::to_string(ignored_count_) + " statements of STL are ignored, the first is " + first_ignored_);
    }
    return std::move(solids_);
  }

 private:
  void refuse(ProblemCode code, const std::string& what, const std::string& cure) {
    report_.refuse(code, what, words_.place(), cure);
  }
  void repair(ProblemCode code, const char* what, const std::string& value, const char* repair) {
    report_.repair({code, what, value, words_.place(), "export the file again", repair});
  }

  /// Reads a statement. The frequent statements are tested first.
  void read_statement(std::string_view keyword) {
    if (is_stl_keyword(keyword, "vertex")) {
      read_vertex();
    } else if (is_stl_keyword(keyword, "facet")) {
      begin_facet();
    } else if (is_stl_keyword(keyword, "endfacet")) {
      end_facet();
    } else if (is_stl_keyword(keyword, "solid")) {
      begin_solid();
    } else if (is_stl_keyword(keyword, "endsolid")) {
      while (words_.is_next_on_line() && !is_stl_keyword(words_.next(), "solid")) words_.take();
    } else if (!is_stl_keyword(keyword, "outer") && !is_stl_keyword(keyword, "loop") &&
               !is_stl_keyword(keyword, "endloop")) {
      ignore(keyword);
    }
  }

  void ignore(std::string_view keyword) {
    if (ignored_count_++ == 0) first_ignored_ = quote(keyword) + " in " + words_.place();
    while (words_.is_next_on_line()) words_.take();
  }

  void begin_solid() {
    const std::string_view name = name_in(words_.behind());
    solids_.push_back({.name = std::string(trim(name))});
    while (words_.is_next_on_line() && words_.next().data() < name.data() + name.size()) words_.take();
  }

  /// Begins a facet. Its normal may be any text, because it is not used.
  void begin_facet() {
    if (is_in_facet_) refuse("stl.facet.nested", "a facet begins within another facet", "export the file again");
    if (solids_.empty()) solids_.emplace_back();
    is_in_facet_ = true;
    is_placed_ = true;
    corners_.clear();
    if (!is_stl_keyword(words_.next(), "normal")) return;
    words_.take();
    for (int i = 0; i < 3 && !is_stl_keyword(words_.next(), "outer"); ++i) words_.take();
  }

  void read_vertex() {
    if (!is_in_facet_) return refuse("stl.facet.nested", "a vertex is outside a facet", "export the file again");
    vec3 corner;
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = words_.take();
      const std::optional<double> number = parse_any_number(word);
      if (!number) return refuse("stl.number.wrong", quote(word) + " is not a number", "give each vertex x y z");
      // The comparison is written so that NaN fails.
      if (is_placed_ && !(std::abs(*number) <= kMaxCoordinate)) {
        is_placed_ = false;
        repair("stl.position.range", "a facet has a vertex coordinate that is not a number up to 1e15", quote(word),
               "promin omits the facet");
      }
      corner[i] = static_cast<float>(*number - report_.center()[i]);
    }
    corners_.push_back(corner);
  }

  void end_facet() {
    if (!is_in_facet_)
      return refuse("stl.facet.nested", "the file ends a facet that has not begun", "export the file again");
    is_in_facet_ = false;
    std::vector<vec3>& all = solids_.back().corners;
    if (corners_.size() < 3) {
      repair("stl.facet.corners", "a facet has fewer than 3 corners", std::to_string(corners_.size()),
             "promin omits the facet");
    } else if (corners_.size() > kMaxPolygonCorners) {
      refuse("stl.facet.corners", "a facet has " + std::to_string(corners_.size()) + " corners", "give it 3");
    } else if (is_placed_ && corners_.size() == 3) {
      all.insert(all.end(), corners_.begin(), corners_.end());
    } else if (is_placed_) {
      repair("stl.facet.corners", "a facet has more than 3 corners", std::to_string(corners_.size()),
             "it is divided into triangles");
      for (const uvec3& triangle : triangulate_polygon(corners_)) {
        for (int i = 0; i < 3; ++i) all.push_back(corners_[triangle[i]]);
      }
    }
  }

  TextWords words_;
  LoadReport& report_;
  std::vector<StlSolid> solids_;
  bool is_in_facet_ = false;
  /// True if all corners of the facet have valid positions.
  bool is_placed_ = true;
  /// The corners of the current facet.
  std::vector<vec3> corners_;
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
