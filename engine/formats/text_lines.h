// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace promin {

/// Returns a text without the byte order mark with which some editors begin a file.
std::string_view without_byte_order_mark(std::string_view text);

/// Returns a text without the zero bytes that some programs write after it.
std::string_view without_zero_bytes_at_end(std::string_view text);

/// Iterates over the lines of a text, which may end in \n, \r\n or \r. Skips a byte order mark.
class TextLines {
 public:
  /// `lines_before` is the number of the file's lines before the text.
  explicit TextLines(std::string_view text, uint64_t lines_before = 0)
      : rest_(lines_before == 0 ? without_byte_order_mark(text) : text), number_(lines_before) {}

  /// Moves to the next line. Returns false at the end.
  bool advance();

  /// Returns the current line without its line end.
  std::string_view line() const { return line_; }
  /// Returns the number of the current line; the first line has the number 1.
  uint64_t number() const { return number_; }
  /// Returns the place of the current line for messages: "line 12".
  std::string place() const { return "line " + std::to_string(number_); }

 private:
  std::string_view rest_;
  std::string_view line_;
  /// The next \n from rest_ on, or the end of the text; not valid if it is before rest_.
  const char* line_feed_ = nullptr;
  uint64_t number_;
};

/// Removes and returns the next word of a line; empty at the end of the line and at a comment.
std::string_view take_word(std::string_view& line);

/// Removes and returns the next word of a line, in a format without comments within lines; empty at the end of the
/// line.
std::string_view take_field(std::string_view& line);

/// Returns the rest of a line without spaces around it.
std::string_view trim(std::string_view line);

/// Returns the finite decimal number that is the whole word; nullopt for other words ("nan", "inf", "0,5", "1e999").
std::optional<double> parse_number(std::string_view word);

/// Returns a number that may also be infinite or NaN ("nan", "-inf", "1.#QNAN"); "1e999" is infinite too. nullopt for
/// other words.
std::optional<double> parse_any_number(std::string_view word);

/// Returns an integer if it is the whole word and fits into 64 bits; nullopt for other words.
std::optional<int64_t> parse_integer(std::string_view word);

}  // namespace promin
