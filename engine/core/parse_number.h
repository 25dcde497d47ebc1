// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace promin {

/// Reads a decimal number at the begin of a text and removes it from the text. The number has the form of
/// std::from_chars, so it has neither a plus sign nor spaces, and a text of an unsigned type has no minus sign. Returns
/// nullopt, and leaves the text unchanged, if there is no number or if its type cannot represent it.
template <typename Number>
std::optional<Number> take_number(std::string_view& text) {
  Number number{};
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<size_t>(rest - text.data()));
  return number;
}

/// Returns the number that is the whole text, in the form of take_number(); nullopt for any other text.
template <typename Number>
std::optional<Number> to_number(std::string_view text) {
  const std::optional<Number> number = take_number<Number>(text);
  return text.empty() ? number : std::nullopt;
}

}  // namespace promin
