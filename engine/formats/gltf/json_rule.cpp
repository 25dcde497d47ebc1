// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/json_rule.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace promin {
namespace {

using nlohmann::json;

/// Every integer up to here is a double.
constexpr double kLargestExact = 0x1p53;

std::string written(double x) {
  std::string text = json(x).dump();
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

/// Calls `use(value, place)` for every value at `path` below `value`.
template <class Use>
void visit(json& value, const std::string& place, std::string_view path, const JsonRule& rule, LoadReport& report,
           const Use& use) {
  if (path.empty()) {
    use(value, place);
  } else if (path.starts_with("[]")) {
    if (!value.is_array()) return;
    for (size_t i = 0; i < value.size(); ++i) {
      visit(value[i], place + "[" + std::to_string(i) + "]", path.substr(2), rule, report, use);
    }
  } else if (path.front() == '.') {
    visit(value, place, path.substr(1), rule, report, use);
  } else {
    if (!value.is_object()) return;
    const size_t end = std::min(path.find_first_of(".["), path.size());
    const std::string_view name = path.substr(0, end);
    const std::string prefix = place.empty() ? "" : place + ".";
    for (auto member = value.begin(); name == "*" && member != value.end(); ++member) {
      visit(member.value(), prefix + member.key(), path.substr(end), rule, report, use);
    }
    if (name == "*") return;
    const auto member = value.find(std::string(name));
    if (member != value.end()) {
      visit(*member, prefix + std::string(name), path.substr(end), rule, report, use);
    } else if (rule.is_required && end == path.size()) {
      report.refuse(quote(name) + " is missing", place.empty() ? "the top level" : place, "add it");
    }
  }
}

/// Length of the array at a path without wildcards; 0 where there is none.
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

/// Checks one value against one rule.
class ValueCheck {
 public:
  ValueCheck(const json& document, const JsonRule& rule, LoadReport& report) : rule_(rule), report_(report) {
    if (rule.kind == JsonKind::kIndex) target_size_ = size_of_array(document, rule.target);
  }

  void operator()(json& value, const std::string& place) const {
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
        if (make_integer(value)) return check_range(value, place);
        return expect(false, value, place, "an integer");
      case JsonKind::kNumber:
        if (value.is_number()) return check_range(value, place);
        return expect(false, value, place, "a number");
      case JsonKind::kNumbers:
        return check_numbers(value, place);
      case JsonKind::kIndex:
        return check_index(value, place);
      case JsonKind::kChoice:
        return check_choice(value, place);
    }
  }

 private:
  void expect(bool is_met, const json& value, const std::string& place, const std::string& wanted) const {
    if (is_met) return;
    const std::string got = value.is_number() ? value.dump() : std::string("a JSON ") + value.type_name();
    report_.refuse(got + " stands where " + wanted + " belongs", place, "write " + wanted);
  }

  /// JSON has one kind of number: 3.0 is a valid index, and 1e99 an integer out of range.
  static bool make_integer(json& value) {
    if (value.is_number_integer()) return true;
    if (!value.is_number_float()) return false;
    const double number = value.get<double>();
    if (std::floor(number) != number) return false;
    if (std::abs(number) <= kLargestExact) value = static_cast<int64_t>(number);
    return true;
  }

  void check_range(const json& value, const std::string& place) const {
    const double number = value.get<double>();
    if (number >= rule_.lo && number <= rule_.hi) return;
    report_.refuse(value.dump() + " is out of range", place,
                   "use a number from " + written(rule_.lo) + " to " + written(rule_.hi));
  }

  void check_numbers(const json& value, const std::string& place) const {
    if (!value.is_array() || value.size() != rule_.count) {
      return expect(false, value, place, "an array of " + std::to_string(rule_.count) + " numbers");
    }
    for (size_t i = 0; i < value.size(); ++i) {
      const std::string element = place + "[" + std::to_string(i) + "]";
      if (value[i].is_number()) {
        check_range(value[i], element);
      } else {
        expect(false, value[i], element, "a number");
      }
    }
  }

  void check_index(json& value, const std::string& place) const {
    if (!make_integer(value)) return expect(false, value, place, "an integer");
    const double number = value.get<double>();
    if (number >= 0.0 && number < static_cast<double>(target_size_)) return;
    const std::string target(rule_.target);
    report_.refuse("index " + value.dump() + " is out of range", place,
                   target_size_ == 0 ? "add the array " + target + " that it points into"
                                     : "use 0 to " + std::to_string(target_size_ - 1) + ", the elements of " + target);
  }

  void check_choice(json& value, const std::string& place) const {
    make_integer(value);
    const std::string got = value.is_string() ? value.get<std::string>() : value.dump();
    std::string_view rest = rule_.target;
    while (!rest.empty()) {
      const size_t end = std::min(rest.find('|'), rest.size());
      if (got == rest.substr(0, end)) return check_choice_type(value, place);
      rest = rest.substr(std::min(end + 1, rest.size()));
    }
    report_.refuse(quote(got) + " is none of " + std::string(rule_.target), place, "use one of them");
  }

  /// "5126", a string, is not the number 5126.
  void check_choice_type(const json& value, const std::string& place) const {
    const bool is_number_wanted = rule_.target.front() >= '0' && rule_.target.front() <= '9';
    if (is_number_wanted != value.is_number()) expect(false, value, place, is_number_wanted ? "a number" : "a string");
  }

  const JsonRule& rule_;
  LoadReport& report_;
  size_t target_size_ = 0;
};

}  // namespace

void check_json_rule(json& document, const JsonRule& rule, LoadReport& report) {
  visit(document, "", rule.path, rule, report, ValueCheck(document, rule, report));
}

}  // namespace promin
