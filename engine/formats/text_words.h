// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "formats/text_lines.h"

namespace promin {

/// Reads words from a text in which line ends separate words like spaces. # begins a comment, which ends at the end of
/// the line.
class TextWords {
 public:
  explicit TextWords(std::string_view text) : lines_(text) { advance(); }

  /// Returns the next word; empty at the end of the file.
  std::string_view next() const { return next_; }
  /// Returns whether the next word is on the same line as the last one.
  bool is_next_on_line() const { return !next_.empty() && next_line_ == line_; }

  std::string_view take() {
    const std::string_view word = next_;
    line_ = next_line_;
    behind_ = rest_;
    advance();
    return word;
  }

  /// Returns the rest of the line after the last word, including comments.
  std::string_view behind() const { return behind_; }

  /// Returns the place of the last word: "line 12".
  std::string place() const { return "line " + std::to_string(line_); }

 private:
  void advance() {
    do {
      next_ = take_word(rest_);
      if (next_.empty()) {
        if (!lines_.advance()) break;
        rest_ = lines_.line();
      }
    } while (next_.empty());
    next_line_ = lines_.number();
  }

  TextLines lines_;
  std::string_view rest_;
  std::string_view behind_;
  std::string_view next_;
  uint64_t next_line_ = 0;
  uint64_t line_ = 0;
};

}  // namespace promin
