// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/json_rule.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "core/json_text.h"

namespace promin {
namespace {

using nlohmann::json;

/// Every integer up to this one can be stored exactly in a double.
constexpr double kLargestExact = 0x1p53;

std::string written(double x) {
  std::string text = json_text(json(x));
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

/// Returns the length of the array at a path without wildcards; 0 if there is no such array.
size_t size_of_array(const json& document, std::string_view path) {
  const json* value = &document;
  while (!path.empty()) {
    const size_t end = std::min(path.find('.'), path.size());
    if (!value->is_object()) return 0;
    const auto member = value->find(std::string(path.substr(0, end)));
    if (member == value->end()) return 0;
    value = &*member;
    path = path.substr(std::min(end + 1, path.size()));
  }
  return value->is_array() ? value->size() : 0;
}

/// Returns the last name of a path: "normalTexture", "cameras[]".
std::string_view last_name(std::string_view path) {
  return path.substr(path.find_last_of('.') + 1);
}

/// Returns the number of steps, into members and elements, of a path.
int count_steps(std::string_view path) {
  int steps = 0;
  for (size_t i = 0; i < path.size(); ++i) {
    const bool begins_name = path[i] != '.' && path[i] != '[' && path[i] != ']' && (i == 0 || path[i - 1] == '.');
    if (begins_name || path[i] == '[') ++steps;
  }
  return steps;
}

/// Returns the path of the part to remove if a rule is broken.
std::string_view part_of(const JsonRule& rule) {
  if (!rule.part.empty()) return rule.part;
  if (!rule.is_required) return rule.path;
  return rule.path.substr(0, rule.path.find_last_of('.'));
}

std::string say_left_out(const JsonRule& rule) {
  const std::string_view part = part_of(rule);
  if (part == rule.path) return "promin ignores it";
  const std::string_view name = last_name(part);
  if (name.ends_with("Texture")) return "promin omits the texture";
  if (name == "cameras[]") return "promin omits the camera";
  if (name == "lights[]" || name == "KHR_lights_punctual" || name == "EXT_lights_area") return "promin omits the light";
  return "promin ignores the object that contains it";
}

/// The place of a value in a document. It is converted to text only if a message needs it.
struct Place {
  static constexpr size_t kNoIndex = std::numeric_limits<size_t>::max();

  const Place* outer = nullptr;
  std::string_view name = {};
  size_t index = kNoIndex;

  std::string text() const {
    if (outer == nullptr) return "";
    const std::string prefix = outer->text();
    if (index != kNoIndex) return prefix + "[" + std::to_string(index) + "]";
    return (prefix.empty() ? "" : prefix + ".") + std::string(name);
  }

  /// Returns whether this is the member of the document itself that has this name.
  bool is_part(std::string_view part) const { return outer != nullptr && outer->outer == nullptr && name == part; }
};

/// Checks the values at the path of one rule.
class RuleCheck {
 public:
  RuleCheck(const json& document, const JsonRule& rule, bool is_strict, LoadReport& report, std::string_view skipped_in,
            const std::vector<bool>& kept)
      : rule_(rule),
        skipped_in_(skipped_in),
        kept_(kept),
        is_strict_(is_strict),
        report_(report),
        level_(count_steps(rule.path.substr(part_of(rule).size())) + 1) {
    if (rule.kind == JsonKind::kIndex) used_.resize(size_of_array(document, rule.target));
  }

  /// Checks every value at `path` below `value`. Returns what must be removed: 0 for nothing, 1 for the value, 2 for
  /// its parent, and so on.
  int visit(json& value, const Place& place, std::string_view path) {
    if (path.empty()) return check_value(value, place) ? 0 : level_;
    if (path.starts_with("[]")) return visit_elements(value, place, path.substr(2));
    if (path.front() == '.') return visit(value, place, path.substr(1));
    return visit_member(value, place, path);
  }

  /// Returns for each element whether a checked index refers to it.
  const std::vector<bool>& used() const { return used_; }

 private:
  int visit_elements(json& array, const Place& place, std::string_view path) {
    if (!array.is_array()) return 0;
    const bool is_partial = place.is_part(skipped_in_);
    int level = 0;
    for (size_t i = 0; i < array.size(); ++i) {
      if (is_partial && (i >= kept_.size() || !kept_[i])) continue;
      const int level_of_element = visit(array[i], Place{.outer = &place, .index = i}, path);
      const bool is_no_object = path.empty() && rule_.kind == JsonKind::kObject;
      if (level_of_element == 1) array[i] = is_no_object ? json::object() : json();
      level = std::max(level, level_of_element - 1);
    }
    return level;
  }

  int visit_member(json& object, const Place& place, std::string_view path) {
    if (!object.is_object()) return 0;
    const size_t end = std::min(path.find_first_of(".["), path.size());
    const std::string_view name = path.substr(0, end);
    if (name == "*") return visit_all_members(object, place, path.substr(end));
    const auto member = object.find(name);
    if (member != object.end()) {
      const int level = visit(*member, Place{.outer = &place, .name = name}, path.substr(end));
      if (level == 1) object.erase(member);
      return std::max(level - 1, 0);
    }
    if (!rule_.is_required || end < path.size()) return 0;
    const bool may_stay = fail("json.missing", quote(name), "", "is missing", place, "add it");
    return may_stay ? 0 : level_ - 1;
  }

  int visit_all_members(json& object, const Place& place, std::string_view path) {
    int level = 0;
    for (auto member = object.begin(); member != object.end();) {
      const int level_of_member = visit(member.value(), Place{.outer = &place, .name = member.key()}, path);
      member = level_of_member == 1 ? object.erase(member) : std::next(member);
      level = std::max(level, level_of_member - 1);
    }
    return level;
  }

  /// The following functions check a value, and return whether it may stay.
  bool check_value(json& value, const Place& place) {
    switch (rule_.kind) {
      case JsonKind::kObject:
        return expect(value.is_object(), value, place, "an object");
      case JsonKind::kArray:
        return expect(value.is_array(), value, place, "an array");
      case JsonKind::kText:
        return expect(value.is_string(), value, place, "a string");
      case JsonKind::kBoolean:
        return expect(value.is_boolean(), value, place, "true or false");
      case JsonKind::kInteger:
        return make_integer(value) ? check_range(value, place) : expect(false, value, place, "an integer");
      case JsonKind::kNumber:
        return check_number(value, place);
      case JsonKind::kNumbers:
        return check_numbers(value, place);
      case JsonKind::kIndex:
        return check_index(value, place);
      case JsonKind::kChoice:
        return check_choice(value, place);
    }
    return true;
  }

  /// Repairs or refuses a value. `shown` is the value in messages; `subject` names its kind.
  bool fail(ProblemCode code, const std::string& subject, const std::string& shown, const std::string& predicate,
            const Place& place, const std::string& cure) {
    const std::string where = place.outer == nullptr ? "the top level" : place.text();
    if (rule_.is_repaired) {
      report_.repair({code, subject + " " + predicate, shown, where, cure, say_left_out(rule_)});
      return false;
    }
    report_.refuse(code, (shown.empty() ? subject : shown) + " " + predicate, where, cure);
    return true;
  }

  bool expect(bool is_met, const json& value, const Place& place, const std::string& wanted) {
    if (is_met) return true;
    const std::string got = value.is_number() ? json_text(value) : std::string("a JSON ") + value.type_name();
    return fail("json.type", "another value", got, "is given where " + wanted + " is expected", place,
                "write " + wanted);
  }

  /// Converts a number to an integer. JSON has one kind of number: 3.0 is a valid index, and 1e99 is an integer out of
  /// range.
  static bool make_integer(json& value) {
    if (value.is_number_integer()) return true;
    if (!value.is_number_float()) return false;
    const double number = value.get<double>();
    if (std::floor(number) != number) return false;
    if (std::abs(number) <= kLargestExact) value = static_cast<int64_t>(number);
    return true;
  }

  bool check_number(json& value, const Place& place) {
    return value.is_number() ? check_range(value, place) : expect(false, value, place, "a number");
  }

  bool check_range(json& value, const Place& place) {
    const auto number = value.get<double>();
    if (number >= rule_.lo && number <= rule_.hi) return true;
    const std::string range = written(rule_.lo) + " to " + written(rule_.hi);
    const std::string cure = "use a number from " + range;
    // A value that is not clamped must lie within a small tolerance of its limit, so the tolerance is relative to the
    // limit.
    const double lo_rounding = rule_.is_clamped ? kMostRounding : kMostRounding * rule_.lo;
    const bool is_rounded = number >= rule_.lo - lo_rounding && number <= rule_.hi + kMostRounding;
    const bool is_kept = rule_.is_clamped || (is_rounded && !is_strict_);
    if (!rule_.is_repaired || !is_kept || rule_.kind == JsonKind::kInteger) {
      return fail("json.range", "a number", json_text(value), "is out of range", place, cure);
    }
    if (!is_rounded || is_strict_) {
      report_.repair({"json.range", "a number is out of range", json_text(value), place.text(), cure,
                      "it is clamped to " + range});
    }
    value = std::clamp(number, rule_.lo, rule_.hi);
    return true;
  }

  bool check_numbers(json& value, const Place& place) {
    if (!value.is_array() || value.size() != rule_.count) {
      return expect(false, value, place, "an array of " + std::to_string(rule_.count) + " numbers");
    }
    bool may_stay = true;
    for (size_t i = 0; i < value.size(); ++i) {
      const bool is_right = check_number(value[i], Place{.outer = &place, .index = i});
      may_stay = may_stay && is_right;
    }
    return may_stay;
  }

  bool check_index(json& value, const Place& place) {
    if (!make_integer(value)) return expect(false, value, place, "an integer");
    const auto number = value.get<double>();
    if (number >= 0.0 && number < static_cast<double>(used_.size())) {
      used_[value.get<size_t>()] = true;
      return true;
    }
    const std::string target(rule_.target);
    const std::string cure = used_.empty() ? "add the array " + target + " that it points into"
                                           : "use an index from 0 to " + std::to_string(used_.size() - 1) +
                                                 ", because " + target + " has no other elements";
    return fail("json.index", "an index", "index " + json_text(value), "is out of range", place, cure);
  }

  bool check_choice(json& value, const Place& place) {
    make_integer(value);
    const std::string got = value.is_string() ? value.get<std::string>() : json_text(value);
    std::string_view rest = rule_.target;
    while (!rest.empty()) {
      const size_t end = std::min(rest.find('|'), rest.size());
      if (got == rest.substr(0, end)) return check_choice_type(value, place);
      rest = rest.substr(std::min(end + 1, rest.size()));
    }
    return fail("json.choice", "a value", quote(got), "is not one of " + std::string(rule_.target), place,
                "use one of them");
  }

  /// Checks the type of a choice: the string "5126" is not the number 5126.
  bool check_choice_type(const json& value, const Place& place) {
    const bool is_number_wanted = rule_.target.front() >= '0' && rule_.target.front() <= '9';
    return expect(is_number_wanted == value.is_number(), value, place, is_number_wanted ? "a number" : "a string");
  }

  const JsonRule& rule_;
  /// The path of the array in which only used elements are checked; empty if all elements are checked.
  std::string_view skipped_in_;
  const std::vector<bool>& kept_;
  bool is_strict_;
  LoadReport& report_;
  /// The value that visit() returns if the rule is broken.
  int level_;
  std::vector<bool> used_;
};

}  // namespace

void JsonCheck::check(const JsonRule& rule, std::string_view only_used) {
  RuleCheck check(document_, rule, is_strict_, report_, only_used, used_[only_used]);
  check.visit(document_, Place(), rule.path);
  if (rule.kind != JsonKind::kIndex) return;
  std::vector<bool>& used = used_[rule.target];
  used.resize(std::max(used.size(), check.used().size()));
  for (size_t i = 0; i < check.used().size(); ++i) used[i] = used[i] || check.used()[i];
}

bool JsonCheck::is_used(std::string_view target, size_t element) const {
  const auto used = used_.find(target);
  return used != used_.end() && element < used->second.size() && used->second[element];
}

void check_json_rule(json& document, const JsonRule& rule, LoadReport& report) {
  JsonCheck(document, false, report).check(rule);
}

}  // namespace promin
