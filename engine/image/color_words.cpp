// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/color_words.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <string>

#include "core/srgb.h"

namespace promin {
namespace {

struct NamedColor {
  std::string_view name;
  uint32_t code;
};

/// Names of colours from https://www.w3.org/TR/css-color-4/#named-colors
constexpr NamedColor kNamedColors[] = {
    {"aqua", 0x00FFFF},    {"black", 0x000000},  {"blue", 0x0000FF},  {"brown", 0xA52A2A},  {"cyan", 0x00FFFF},
    {"fuchsia", 0xFF00FF}, {"gray", 0x808080},   {"green", 0x008000}, {"grey", 0x808080},   {"lime", 0x00FF00},
    {"magenta", 0xFF00FF}, {"maroon", 0x800000}, {"navy", 0x000080},  {"olive", 0x808000},  {"orange", 0xFFA500},
    {"pink", 0xFFC0CB},    {"purple", 0x800080}, {"red", 0xFF0000},   {"silver", 0xC0C0C0}, {"teal", 0x008080},
    {"white", 0xFFFFFF},   {"yellow", 0xFFFF00}};

vec3 color_of_code(uint32_t code) {
  const uvec3 bytes(code >> 16 & 0xFF, code >> 8 & 0xFF, code & 0xFF);
  return vec3(dvec3(bytes) / 255.0);
}

/// Reads the digits after "#".
std::optional<uint32_t> read_code(std::string digits) {
  // In the short form each digit stands for two equal digits.
  if (digits.size() == 3) digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
  uint32_t code = 0;
  const char* end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, code, 16);
  if (digits.size() != 6 || error != std::errc() || rest != end) return {};
  return code;
}

}  // namespace

std::optional<vec3> find_color(std::string_view word) {
  std::string lower(word);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower.starts_with('#')) {
    const std::optional<uint32_t> code = read_code(lower.substr(1));
    return code ? std::optional(color_of_code(*code)) : std::nullopt;
  }
  const auto* named = std::ranges::find(kNamedColors, lower, &NamedColor::name);
  return named == std::end(kNamedColors) ? std::nullopt : std::optional(color_of_code(named->code));
}

std::vector<std::string_view> color_names() {
  std::vector<std::string_view> names;
  for (const NamedColor& color : kNamedColors) names.push_back(color.name);
  return names;
}

vec3 linear_of_srgb(const vec3& color) {
  vec3 linear;
  for (int i = 0; i < 3; ++i) linear[i] = static_cast<float>(srgb_to_linear(static_cast<double>(color[i])));
  return linear;
}

}  // namespace promin
