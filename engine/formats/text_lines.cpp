// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "core/parse_number.h"

namespace promin {
namespace {

constexpr std::string_view kSpace = " \t\r\f\v";

/// Returns whether a character is in kSpace.
constexpr bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r' && c != '\n');
}

/// Returns the next word. This is a template, because splitting into words is the most frequent operation on a text.
template <bool kHasComments>
std::string_view take_part(std::string_view& line) {
  size_t begin = 0;
  while (begin < line.size() && is_space(line[begin])) ++begin;
  size_t end = begin;
  while (end < line.size() && !is_space(line[end]) && !(kHasComments && line[end] == '#')) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

template <class Number>
std::optional<Number> parse_whole(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  return to_number<Number>(word);
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

std::string_view without_zero_bytes_at_end(std::string_view text) {
  return text.substr(0, text.find_last_not_of('\0') + 1);
}

bool TextLines::advance() {
  if (rest_.empty()) return false;
  const char* const begin = rest_.data();
  const char* const end = begin + rest_.size();
  // The position is kept between lines, so that a file whose lines end in \r is not searched to its end for each line.
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
  return take_part<true>(line);
}

std::string_view take_field(std::string_view& line) {
  return take_part<false>(line);
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

std::optional<double> parse_any_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_whole = end == word.data() + word.size();
  if (error == std::errc() && is_whole) return number;
  // The number is too large or too small for a double.
  if (error == std::errc::result_out_of_range && is_whole) return std::strtod(std::string(word).c_str(), nullptr);
  // The C library of Windows wrote infinity and NaN as "-1.#INF" and "1.#QNAN".
  const size_t mark = word.find(".#");
  if (mark == std::string_view::npos) return std::nullopt;
  const double infinite = std::numeric_limits<double>::infinity();
  if (word.substr(mark + 2).starts_with("INF")) return word.starts_with('-') ? -infinite : infinite;
  return std::numeric_limits<double>::quiet_NaN();
}

std::optional<int64_t> parse_integer(std::string_view word) {
  return parse_whole<int64_t>(word);
}

}  // namespace promin
