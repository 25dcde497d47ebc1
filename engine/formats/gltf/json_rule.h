// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

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
};

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

}  // namespace rules

/// Holds a document against one rule; problems go to the report with their path in the document. Integers written as
/// 3.0 become 3.
void check_json_rule(nlohmann::json& document, const JsonRule& rule, LoadReport& report);

}  // namespace promin
