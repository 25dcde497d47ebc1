// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

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
  const char* const begin = rest_.data();
  const char* const end = begin + rest_.size();
  // Kept from line to line, so that a file whose lines end in \r alone is not searched to its end for each.
  if (line_feed_ == nullptr || line_feed_ < begin) {
    const void* const found = std::memchr(begin, '\n', rest_.size());
    line_feed_ = found == nullptr ? end : static_cast<const char*>(found);
  }
  const void* const found = std::memchr(begin, '\r', static_cast<size_t>(line_feed_ - begin));
  const char* const stop = found == nullptr ? line_feed_ : static_cast<const char*>(found);
  line_ = std::string_view(begin, static_cast<size_t>(stop - begin));
  const char* next = stop == end ? end : stop + 1;
  if (stop != line_feed_ && next == line_feed_ && next != end) ++next;
  rest_.remove_prefix(static_cast<size_t>(next - begin));
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
