// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "formats/load_report.h"
#include "formats/ply/header.h"
#include "formats/text_lines.h"

namespace promin {

/// Reads numbers from the rows of a binary PLY file. After the end of the file, and after a problem, all numbers are 0.
template <std::endian kOrder>
class PlyBinaryRows {
 public:
  PlyBinaryRows(std::string_view body, uint64_t /*header_lines*/) : rest_(body) {}

  void start_row() {}
  void end_row(LoadReport& /*report*/) {}

  double take_any(PlyType type) { return take(type); }
  double take(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return static_cast<double>(static_cast<int8_t>(take_bytes<uint8_t>()));
      case PlyType::kUint8:
        return static_cast<double>(take_bytes<uint8_t>());
      case PlyType::kInt16:
        return static_cast<double>(static_cast<int16_t>(take_bytes<uint16_t>()));
      case PlyType::kUint16:
        return static_cast<double>(take_bytes<uint16_t>());
      case PlyType::kInt32:
        return static_cast<double>(static_cast<int32_t>(take_bytes<uint32_t>()));
      case PlyType::kUint32:
        return static_cast<double>(take_bytes<uint32_t>());
      case PlyType::kFloat32:
        return static_cast<double>(std::bit_cast<float>(take_bytes<uint32_t>()));
      default:
        return std::bit_cast<double>(take_bytes<uint64_t>());
    }
  }

  /// Returns the largest number of values that can follow.
  size_t most_numbers(PlyType type) const { return rest_.size() / size_of(type); }
  /// Returns the problem, or an empty string.
  const std::string& problem() const { return problem_; }
  std::string place() const { return {}; }

 private:
  template <class Word>
  Word take_bytes() {
    Word word = 0;
    if (rest_.size() < sizeof(Word)) {
      problem_ = "the file ends within its rows";
      return word;
    }
    if constexpr (kOrder == std::endian::native) {
      std::memcpy(&word, rest_.data(), sizeof(Word));
    } else {
      for (size_t i = 0; i < sizeof(Word); ++i) {
        word = static_cast<Word>(word | Word{static_cast<uint8_t>(rest_[i])} << (8 * (sizeof(Word) - 1 - i)));
      }
    }
    rest_.remove_prefix(sizeof(Word));
    return word;
  }

  std::string_view rest_;
  std::string problem_;
};

/// Reads numbers from the rows of a text PLY file, where each row is a line. It has the same functions as
/// PlyBinaryRows.
class PlyTextRows {
 public:
  PlyTextRows(std::string_view body, uint64_t header_lines) : lines_(without_zero_bytes_at_end(body), header_lines) {}

  void start_row() {
    do {
      if (!lines_.advance()) {
        problem_ = "the file ends within its rows";
        return;
      }
      rest_ = trim(lines_.line());
    } while (rest_.empty());
  }

  void end_row(LoadReport& report) {
    if (problem_.empty() && !rest_.empty() && !take_field(rest_).empty()) {
      report.warn("numbers beyond the properties of an element are ignored");
    }
    rest_ = {};
  }

  /// Reads a number that may be infinite or NaN ("nan"), which programs write for unknown values.
  double take(PlyType type) {
    const double number = take_any(type);
    if (!is_number_ && problem_.empty()) problem_ = quote(word_) + " is not a number";
    return number;
  }

  /// Reads any word as a number; NaN if it is not a number.
  double take_any(PlyType /*type*/) {
    word_ = take_field(rest_);
    if (word_.empty() && problem_.empty()) problem_ = "a row has fewer numbers than its element has properties";
    const std::optional<double> number = parse_any_number(word_);
    is_number_ = number.has_value();
    return number.value_or(std::numeric_limits<double>::quiet_NaN());
  }

  size_t most_numbers(PlyType /*type*/) const { return rest_.size(); }
  const std::string& problem() const { return problem_; }
  std::string place() const { return lines_.place(); }

 private:
  TextLines lines_;
  std::string_view rest_;
  std::string_view word_;
  bool is_number_ = true;
  std::string problem_;
};

}  // namespace promin
