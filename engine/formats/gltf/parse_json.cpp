// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/parse_json.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "core/json_text.h"

namespace promin {
namespace {

using nlohmann::json;

/// Returns the depth of nesting. It counts brackets outside strings; the parser checks whether they match.
int depth_of(std::string_view text) {
  int depth = 0;
  int deepest = 0;
  bool is_in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_in_string) {
      if (c == '\\') ++i;
      if (c == '"') is_in_string = false;
    } else if (c == '"') {
      is_in_string = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return deepest;
}

/// Returns the text with each number beyond the range of double replaced by the largest double of the same sign. The
/// parser cannot read such numbers; range checks find the replacement.
std::string bound_numbers(std::string_view text) {
  constexpr std::string_view kLargest = "1.7976931348623157e308";
  constexpr std::string_view kOfNumbers = "0123456789+-.eE";
  std::string bounded;
  bool is_in_string = false;
  for (size_t i = 0; i < text.size();) {
    const char c = text[i];
    const bool is_number = !is_in_string && (c == '-' || (c >= '0' && c <= '9'));
    size_t end = i + 1;
    if (is_in_string && c == '\\') end = i + 2;
    if (is_number) end = text.find_first_not_of(kOfNumbers, i);
    if (c == '"') is_in_string = !is_in_string;
    const std::string part(text.substr(i, end - i));
    if (is_number && std::isinf(std::strtod(part.c_str(), nullptr))) {
      if (c == '-') bounded += c;
      bounded += kLargest;
    } else {
      bounded += part;
    }
    i = std::min(end, text.size());
  }
  return bounded;
}

/// The text is changed only if the parser reports a number beyond the range of double, because very few files have one.
json parse_bounded(std::string_view text) {
  try {
    return read_json(text);
  } catch (const json::out_of_range&) {
    return read_json(bound_numbers(text));
  }
}

}  // namespace

json parse_json(std::string_view text, LoadReport& report, const std::string& cure) {
  const int depth = depth_of(text);
  if (depth > kMaxJsonDepth) {
    report.refuse("json.depth",
                  "the JSON has " + std::to_string(depth) + " nested levels, more than the limit of " +
                      std::to_string(kMaxJsonDepth),
                  "", cure);
  }
  report.throw_if_refused();
  json document;
  try {
    document = parse_bounded(text);
  } catch (const json::exception& error) {
    // The message is, for example, "[json.exception.parse_error.101] parse error at line 3, column 5: ...".
    std::string message = error.what();
    if (const size_t end = message.find("] "); end != std::string::npos) message.erase(0, end + 2);
    report.refuse("json.syntax", "the JSON cannot be read: " + message, "", cure);
  }
  report.throw_if_refused();
  return document;
}

}  // namespace promin
