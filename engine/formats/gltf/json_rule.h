// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "formats/load_report.h"

namespace promin {

enum class JsonKind { kObject, kArray, kText, kBoolean, kInteger, kNumber, kNumbers, kIndex, kChoice };

/// What must stand at a path. "[]" is every element of an array, "*" every member of an object.
struct JsonRule {
  std::string_view path;
  JsonKind kind = JsonKind::kObject;
  bool is_required = false;
  /// Range of integers and numbers, ends included.
  double lo = 0.0;
  double hi = 0.0;
  /// Length of kNumbers.
  size_t count = 0;
  /// kIndex: path of the array it points into. kChoice: the values, separated by '|'.
  std::string_view target = {};
  /// Whether a value that breaks the rule is left out, with a warning, instead of refused. Where it is required, what
  /// holds it is left out.
  bool is_repaired = false;
  /// Whether a repaired number out of range is clamped. That gives no warning where the number is off by rounding.
  bool is_clamped = true;
  /// What is left out instead: a part of `path` from its beginning; empty for the above.
  std::string_view part = {};
};

/// By how much numbers that exporters rounded may miss their range.
inline constexpr double kMostRounding = 1e-3;

/// How tables write their rows: `index("scene", "scenes")`.
namespace rules {

constexpr JsonRule object(std::string_view path) {
  return {.path = path, .kind = JsonKind::kObject};
}
constexpr JsonRule array(std::string_view path) {
  return {.path = path, .kind = JsonKind::kArray};
}
constexpr JsonRule text(std::string_view path) {
  return {.path = path, .kind = JsonKind::kText};
}
constexpr JsonRule boolean(std::string_view path) {
  return {.path = path, .kind = JsonKind::kBoolean};
}
constexpr JsonRule index(std::string_view path, std::string_view target) {
  return {.path = path, .kind = JsonKind::kIndex, .target = target};
}
constexpr JsonRule choice(std::string_view path, std::string_view choices) {
  return {.path = path, .kind = JsonKind::kChoice, .target = choices};
}
constexpr JsonRule integer(std::string_view path, double lo, double hi) {
  return {.path = path, .kind = JsonKind::kInteger, .lo = lo, .hi = hi};
}
constexpr JsonRule number(std::string_view path, double lo, double hi) {
  return {.path = path, .kind = JsonKind::kNumber, .lo = lo, .hi = hi};
}
constexpr JsonRule numbers(std::string_view path, size_t count, double lo, double hi) {
  return {.path = path, .kind = JsonKind::kNumbers, .lo = lo, .hi = hi, .count = count};
}
constexpr JsonRule needed(JsonRule rule) {
  rule.is_required = true;
  return rule;
}
constexpr JsonRule unclamped(JsonRule rule) {
  rule.is_clamped = false;
  return rule;
}
constexpr JsonRule leaving_out(std::string_view part, JsonRule rule) {
  rule.part = part;
  return rule;
}

}  // namespace rules

/// Holds a document against rules; problems and repairs go to the report with their path in the document. Integers
/// written as 3.0 become 3. What is left out is gone, or null where it is an element of an array, or an empty object
/// where that element is no object at all.
class JsonCheck {
 public:
  JsonCheck(nlohmann::json& document, bool is_strict, LoadReport& report)
      : document_(document), is_strict_(is_strict), report_(report) {}

  /// In the array at the path `only_used`, if there is one, only elements that indices point to are checked.
  void check(const JsonRule& rule, std::string_view only_used = {});

  /// Whether an index that was checked points to the element of the array at `target`.
  bool is_used(std::string_view target, size_t element) const;

 private:
  nlohmann::json& document_;
  bool is_strict_;
  LoadReport& report_;
  std::map<std::string_view, std::vector<bool>> used_;
};

/// Holds a document against one rule.
void check_json_rule(nlohmann::json& document, const JsonRule& rule, LoadReport& report);

}  // namespace promin
