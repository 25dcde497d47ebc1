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

std::string_view cut_zero_tail(std::string_view text, const std::string& place, LoadReport& report) {
  const size_t last = text.find_last_not_of('\0');
  if (last == std::string_view::npos || last + 1 == text.size()) return text;
  report.repair({"the text ends in zero bytes", std::to_string(text.size() - last - 1), place,
                 "export the file again, or copy it again", "they are cut off"});
  return text.substr(0, last + 1);
}

bool TextLines::advance() {
  if (rest_.empty()) return false;
  newline_ = find_from(newline_, '\n');
  return_ = find_from(return_, '\r');
  const char* end = std::min(newline_, return_);
  line_ = rest_.substr(0, static_cast<size_t>(end - rest_.data()));
  const size_t end_size = newline_ == return_ + 1 ? 2 : 1;
  rest_.remove_prefix(std::min(line_.size() + end_size, rest_.size()));
  ++number_;
  return true;
}

const char* TextLines::find_from(const char* known, char end) const {
  if (known != nullptr && known >= rest_.data()) return known;
  return rest_.data() + std::min(rest_.find(end), rest_.size());
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
