// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/json_text.h"

#include <nlohmann/json.hpp>

namespace promin {

using nlohmann::json;
using nlohmann::ordered_json;

std::string json_text(const json& value, int indent) {
  return value.dump(indent, ' ', false, json::error_handler_t::replace);
}

std::string json_text(const ordered_json& value, int indent) {
  return value.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

json read_json(std::string_view text) {
  return json::parse(text);
}

ordered_json read_ordered_json(std::string_view text) {
  return ordered_json::parse(text);
}

ordered_json read_ordered_json_or_discard(std::string_view text) {
  return ordered_json::parse(text, nullptr, false);
}

}  // namespace promin
