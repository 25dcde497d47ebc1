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

/// A rule for the value at a path. In a path, "[]" stands for every element of an array, and "*" for every member of an
/// object.
struct JsonRule {
  std::string_view path;
  JsonKind kind = JsonKind::kObject;
  bool is_required = false;
  /// Smallest and largest allowed value of integers and numbers.
  double lo = 0.0;
  double hi = 0.0;
  /// Length of an array of kNumbers.
  size_t count = 0;
  /// For kIndex, the path of the array to which the index refers. For kChoice, the allowed values, separated by '|'.
  std::string_view target = {};
  /// If true, a value that breaks the rule is removed with a warning; if false, it is refused. If the value is
  /// required, the object that contains it is removed.
  bool is_repaired = false;
  /// True if a repaired number out of range is clamped. There is no warning if the number is out of range only by
  /// rounding.
  bool is_clamped = true;
  /// The part to remove in place of the value: a prefix of `path`. If empty, `is_repaired` describes which part is
  /// removed.
  std::string_view part = {};
};

/// The largest distance from the allowed range of a number that an exporter has rounded.
inline constexpr double kMostRounding = 1e-3;

/// Functions that make rows of tables of rules, such as `index("scene", "scenes")`.
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

/// Checks a document against rules. Problems and repairs go to the report with their path in the document. Integers
/// written as 3.0 become 3. Removed members are erased; removed elements of an array become null, or an empty object if
/// they are not objects.
class JsonCheck {
 public:
  JsonCheck(nlohmann::json& document, bool is_strict, LoadReport& report)
      : document_(document), is_strict_(is_strict), report_(report) {}

  /// Checks the document against a rule. In the array at the path `only_used`, if given, it checks only elements to
  /// which indices refer.
  void check(const JsonRule& rule, std::string_view only_used = {});

  /// Returns whether a checked index refers to this element of the array at `target`.
  bool is_used(std::string_view target, size_t element) const;

 private:
  nlohmann::json& document_;
  bool is_strict_;
  LoadReport& report_;
  std::map<std::string_view, std::vector<bool>> used_;
};

/// Checks a document against one rule.
void check_json_rule(nlohmann::json& document, const JsonRule& rule, LoadReport& report);

}  // namespace promin
