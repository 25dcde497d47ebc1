// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/parse_json.h"

#include <algorithm>

namespace promin {
namespace {

using nlohmann::json;

/// Brackets outside of strings; whether they match is the parser's business.
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

}  // namespace

json parse_json(std::string_view text, LoadReport& report, const std::string& cure) {
  const int depth = depth_of(text);
  if (depth > kMaxJsonDepth) {
    report.refuse("the JSON nests " + std::to_string(depth) + " deep, more than " + std::to_string(kMaxJsonDepth), "",
                  cure);
  }
  report.throw_if_refused();
  json document;
  try {
    document = json::parse(text);
  } catch (const json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
    std::string message = error.what();
    if (const size_t end = message.find("] "); end != std::string::npos) message.erase(0, end + 2);
    report.refuse("the JSON cannot be read: " + message, "", cure);
  }
  report.throw_if_refused();
  return document;
}

}  // namespace promin
