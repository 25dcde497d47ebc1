// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/utf8.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/json_text.h"

namespace promin {

std::string to_utf8(std::string_view text) {
  if (std::none_of(text.begin(), text.end(), [](char c) { return (c & 0x80) != 0; })) return std::string(text);
  using Json = nlohmann::json;
  return read_json(json_text(Json(text))).get<std::string>();
}

std::string to_one_line(std::string_view text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    // U+0080 to U+009F are control characters of two bytes.
    const bool ends_control = byte >= 0x80 && byte < 0xA0 && !line.empty() && line.back() == '\xC2';
    if (ends_control) line.pop_back();
    line += is_control(byte) || ends_control ? '?' : c;
  }
  return line;
}

}  // namespace promin
