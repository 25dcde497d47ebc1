// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace promin {

/// A text without the byte order mark that some editors begin a file with.
std::string_view without_byte_order_mark(std::string_view text);

/// A text without the zero bytes that some programs write behind it.
std::string_view without_zero_bytes_at_end(std::string_view text);

/// Walks the lines of a text, whether they end in \n, \r\n or \r, without the byte order mark of a file.
class TextLines {
 public:
  /// `lines_before` of the file come before the text.
  explicit TextLines(std::string_view text, uint64_t lines_before = 0)
      : rest_(lines_before == 0 ? without_byte_order_mark(text) : text), number_(lines_before) {}

  /// Goes to the next line; false at the end.
  bool advance();

  /// The current line without its end.
  std::string_view line() const { return line_; }
  /// Its number, from 1 on.
  uint64_t number() const { return number_; }
  /// The place of the line for messages: "line 12".
  std::string place() const { return "line " + std::to_string(number_); }

 private:
  std::string_view rest_;
  std::string_view line_;
  /// The next \n from rest_ on, or the end of the text; stale where it lies before rest_.
  const char* line_feed_ = nullptr;
  uint64_t number_;
};

/// Takes the next word off a line; empty at its end or at a comment.
std::string_view take_word(std::string_view& line);

/// Takes the next word off a line, in a format that has no comments within lines; empty at its end.
std::string_view take_field(std::string_view& line);

/// The rest of a line without spaces around it.
std::string_view trim(std::string_view line);

/// A finite decimal number that is the whole word; nullopt for anything else ("nan", "inf", "0,5", "1e999").
std::optional<double> parse_number(std::string_view word);

/// A number as programs write any: also infinite or NaN ("nan", "-inf", "1.#QNAN"), which "1e999" is too; nullopt where
/// the word is none of these.
std::optional<double> parse_any_number(std::string_view word);

/// An integer that is the whole word and fits.
std::optional<int64_t> parse_integer(std::string_view word);

}  // namespace promin
