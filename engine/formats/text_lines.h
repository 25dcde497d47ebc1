// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "formats/load_report.h"

namespace promin {

/// A text without the byte order mark that some editors begin a file with.
std::string_view without_byte_order_mark(std::string_view text);

/// A text without the zero bytes at its end, which some programs pad a file with: the report repairs them, at `place`.
/// A text of zero bytes alone is kept.
std::string_view cut_zero_tail(std::string_view text, const std::string& place, LoadReport& report);

/// Walks the lines of a text, whether they end in \n, \r or \r\n, without the byte order mark of a file.
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
  /// `known` where it lies in the rest, else the next such character.
  const char* find_from(const char* known, char end) const;

  std::string_view rest_;
  std::string_view line_;
  /// The next \n and \r of the rest, or the end of the text: each is searched for once, however many lines end in the
  /// other.
  const char* newline_ = nullptr;
  const char* return_ = nullptr;
  uint64_t number_;
};

/// Takes the next word off a line; empty at its end or at a comment.
std::string_view take_word(std::string_view& line);

/// The rest of a line without spaces around it.
std::string_view trim(std::string_view line);

/// A finite decimal number that is the whole word; nullopt for anything else ("nan", "inf", "0,5", "1e999").
std::optional<double> parse_number(std::string_view word);

/// An integer that is the whole word and fits.
std::optional<int64_t> parse_integer(std::string_view word);

}  // namespace promin
