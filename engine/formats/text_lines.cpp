// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace promin {
namespace {

constexpr std::string_view kSpace = " \t\r\f\v";

template <class Number>
std::optional<Number> parse_whole(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

bool TextLines::advance() {
  if (rest_.empty()) return false;
  const size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  ++number_;
  return true;
}

std::string_view take_word(std::string_view& line) {
  const size_t begin = std::min(line.find_first_not_of(kSpace), line.size());
  line.remove_prefix(begin);
  const size_t end = std::min(line.find_first_of(" \t\r\f\v#"), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

std::string_view trim(std::string_view line) {
  const size_t begin = std::min(line.find_first_not_of(kSpace), line.size());
  line.remove_prefix(begin);
  return line.substr(0, line.find_last_not_of(kSpace) + 1);
}

std::optional<double> parse_number(std::string_view word) {
  const std::optional<double> number = parse_whole<double>(word);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<int64_t> parse_integer(std::string_view word) {
  return parse_whole<int64_t>(word);
}

}  // namespace promin
