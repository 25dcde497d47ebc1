// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/etc1s.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "image/plugin/bit_reader.h"

namespace {

using Bytes = std::span<const unsigned char>;

[[noreturn]] void refuse_data() {
  throw std::runtime_error("its BasisLZ data is damaged");
}

constexpr uint32_t kMostBits = 16;

/// A canonical prefix code like those of Deflate (RFC 1951, 3.2.2).
class PrefixCode {
 public:
  /// Creates a code. `lengths` has the length of each symbol's word, 0 for a symbol without a word.
  explicit PrefixCode(const std::vector<uint8_t>& lengths) {
    for (const uint8_t length : lengths) ++counts_[length];
    counts_[0] = 0;
    for (uint32_t length = 1; length <= kMostBits; ++length) {
      for (size_t symbol = 0; symbol < lengths.size(); ++symbol) {
        if (lengths[symbol] == length) symbols_.push_back(static_cast<uint32_t>(symbol));
      }
    }
  }

  uint32_t take(BitReader& bits) const {
    uint32_t word = 0;
    uint32_t first = 0;
    uint32_t place = 0;
    for (uint32_t length = 1; length <= kMostBits; ++length) {
      word = word << 1 | bits.take(1);
      first <<= 1;
      if (word < first + counts_[length]) return symbols_[place + word - first];
      first += counts_[length];
      place += counts_[length];
    }
    refuse_data();
  }

 private:
  std::array<uint32_t, kMostBits + 1> counts_{};
  std::vector<uint32_t> symbols_;
};

/// Reads a code: the lengths of its words, which are themselves encoded with a small code.
PrefixCode read_code(BitReader& bits) {
  constexpr std::array<uint8_t, 21> kOrder = {17, 18, 19, 20, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15, 16};
  const uint32_t symbol_count = bits.take(14);
  if (symbol_count == 0) return PrefixCode({});
  const uint32_t length_count = bits.take(5);
  if (length_count > kOrder.size()) refuse_data();
  std::vector<uint8_t> small(kOrder.size());
  for (uint32_t i = 0; i < length_count; ++i) small[kOrder[i]] = static_cast<uint8_t>(bits.take(3));
  const PrefixCode code_of_lengths(small);
  std::vector<uint8_t> lengths;
  while (lengths.size() < symbol_count) {
    const uint32_t symbol = code_of_lengths.take(bits);
    if (symbol <= kMostBits) {
      lengths.push_back(static_cast<uint8_t>(symbol));
      continue;
    }
    const bool is_repeat = symbol >= 19;
    if (is_repeat && (lengths.empty() || lengths.back() == 0)) refuse_data();
    const uint8_t length = is_repeat ? lengths.back() : 0;
    const uint32_t run = symbol == 17   ? 3 + bits.take(3)
                         : symbol == 18 ? 11 + bits.take(7)
                         : symbol == 19 ? 3 + bits.take(2)
                                        : 7 + bits.take(7);
    lengths.insert(lengths.end(), run, length);
  }
  if (lengths.size() > symbol_count) refuse_data();
  return PrefixCode(lengths);
}

/// Reads a number in chunks of this many bits. A bit after each chunk says whether another chunk follows.
uint32_t take_chunks(BitReader& bits, uint32_t chunk_bits) {
  uint32_t number = 0;
  for (uint32_t shift = 0; shift < 32; shift += chunk_bits) {
    number |= bits.take(chunk_bits) << shift;
    if (bits.take(1) == 0) return number;
  }
  refuse_data();
}

/// The four colours of a block, indexed by selector.
using Palette = std::array<std::array<uint8_t, 3>, 4>;
/// The selectors of a block: a byte for each row, with two bits for each texel.
using Selectors = std::array<uint8_t, 4>;

/// Numbers that ETC1 adds to a colour, indexed by table and selector.
constexpr std::array<std::array<int, 4>, 8> kModifiers = {{{-8, -2, 2, 8},
                                                           {-17, -5, 5, 17},
                                                           {-29, -9, 9, 29},
                                                           {-42, -13, 13, 42},
                                                           {-60, -18, 18, 60},
                                                           {-80, -24, 24, 80},
                                                           {-106, -33, 33, 106},
                                                           {-183, -47, 47, 183}}};

Palette make_palette(const std::array<uint32_t, 3>& color5, uint32_t table) {
  Palette palette;
  for (size_t selector = 0; selector < palette.size(); ++selector) {
    for (size_t channel = 0; channel < 3; ++channel) {
      const auto base = static_cast<int>(color5[channel] << 3 | color5[channel] >> 2);
      palette[selector][channel] = static_cast<uint8_t>(std::clamp(base + kModifiers[table][selector], 0, 255));
    }
  }
  return palette;
}

std::vector<Palette> read_palettes(Bytes bytes, uint32_t count) {
  BitReader bits(bytes);
  const std::array<PrefixCode, 3> color_codes = {read_code(bits), read_code(bits), read_code(bits)};
  const PrefixCode table_code = read_code(bits);
  const bool is_grey = bits.take(1) != 0;
  std::array<uint32_t, 3> color = {16, 16, 16};
  uint32_t table = 0;
  std::vector<Palette> palettes;
  for (uint32_t i = 0; i < count; ++i) {
    table = (table + table_code.take(bits)) % kModifiers.size();
    for (size_t channel = 0; channel < (is_grey ? 1U : 3U); ++channel) {
      const size_t code = color[channel] <= 9 ? 0 : color[channel] <= 21 ? 1 : 2;
      color[channel] = (color[channel] + color_codes[code].take(bits)) % 32;
    }
    if (is_grey) color[1] = color[2] = color[0];
    palettes.push_back(make_palette(color, table));
  }
  return palettes;
}

std::vector<Selectors> read_selectors(Bytes bytes, uint32_t count) {
  BitReader bits(bytes);
  // These bits request codebooks outside the file. No version of the format has them.
  if (bits.take(2) != 0) refuse_data();
  const bool is_raw = bits.take(1) != 0;
  const PrefixCode code = is_raw ? PrefixCode({}) : read_code(bits);
  Selectors rows{};
  std::vector<Selectors> selectors;
  for (uint32_t i = 0; i < count; ++i) {
    for (uint8_t& row : rows) {
      row = static_cast<uint8_t>(is_raw || i == 0 ? bits.take(8) : row ^ code.take(bits));
    }
    selectors.push_back(rows);
  }
  return selectors;
}

/// The selectors that were used last, approximately in the order of their use.
class History {
 public:
  explicit History(size_t size) : values_(size), next_(size / 2) {}

  void add(uint32_t value) {
    if (values_.empty()) return;
    values_[next_++] = value;
    if (next_ == values_.size()) next_ = values_.size() / 2;
  }
  uint32_t use(size_t place) {
    if (place >= values_.size()) refuse_data();
    const uint32_t value = values_[place];
    std::swap(values_[place / 2], values_[place]);
    return value;
  }
  size_t size() const { return values_.size(); }

 private:
  std::vector<uint32_t> values_;
  size_t next_;
};

struct Codes {
  PrefixCode predictions;
  PrefixCode palette_deltas;
  PrefixCode selectors;
  PrefixCode runs;
  size_t history_size;
};

Codes read_codes(Bytes bytes) {
  BitReader bits(bytes);
  PrefixCode predictions = read_code(bits);
  PrefixCode deltas = read_code(bits);
  PrefixCode selectors = read_code(bits);
  PrefixCode runs = read_code(bits);
  return {std::move(predictions), std::move(deltas), std::move(selectors), std::move(runs), bits.take(13)};
}

/// Reads the blocks of a slice, row after row.
class SliceReader {
 public:
  SliceReader(const Codes& codes, Bytes slice, uint32_t palette_count, uint32_t selector_count, uint32_t column_count)
      : codes_(codes),
        bits_(slice),
        palette_count_(palette_count),
        selector_count_(selector_count),
        history_(codes.history_size),
        above_(column_count),
        predictions_below_(column_count) {}

  /// Reads the numbers of the next block's palette and selectors. `row` and `column` are the block's position.
  std::pair<uint32_t, uint32_t> read(uint32_t row, uint32_t column) {
    const uint32_t palette = read_palette(row, column);
    const uint32_t selectors = read_selectors();
    if (palette >= palette_count_ || selectors >= selector_count_) refuse_data();
    return {palette, selectors};
  }

 private:
  /// Reads the predictions for two by two blocks. Two bits for each block say where its palette comes from.
  uint32_t read_prediction() {
    constexpr uint32_t kRepeat = 256;
    if (prediction_run_ > 0) {
      --prediction_run_;
      return last_prediction_;
    }
    const uint32_t symbol = codes_.predictions.take(bits_);
    if (symbol == kRepeat) {
      prediction_run_ = take_chunks(bits_, 4) + 2;
    } else {
      last_prediction_ = symbol;
    }
    return last_prediction_;
  }

  uint32_t read_palette(uint32_t row, uint32_t column) {
    if (column % 2 == 0) {
      if (row % 2 == 0) {
        prediction_ = read_prediction();
        predictions_below_[column] = prediction_ >> 4;
      } else {
        prediction_ = predictions_below_[column];
      }
    }
    const uint32_t from = prediction_ & 3;
    prediction_ >>= 2;
    if ((from == 0 && column == 0) || (from == 1 && row == 0) || (from == 2 && (row == 0 || column == 0)))
      refuse_data();
    const uint32_t above_left = above_left_;
    above_left_ = above_[column];
    if (from == 1) last_palette_ = above_[column];
    if (from == 2) last_palette_ = above_left;
    if (from == 3) {
      last_palette_ += codes_.palette_deltas.take(bits_);
      if (last_palette_ >= palette_count_) last_palette_ -= palette_count_;
    }
    above_[column] = last_palette_;
    return last_palette_;
  }

  uint32_t read_selectors() {
    constexpr uint32_t kLongRun = 63;
    uint32_t symbol = selector_count_;
    if (selector_run_ > 0) {
      --selector_run_;
    } else {
      symbol = codes_.selectors.take(bits_);
      if (symbol == selector_count_ + history_.size()) {
        const uint32_t run = codes_.runs.take(bits_);
        selector_run_ = (run == kLongRun ? take_chunks(bits_, 7) : run) + 2;
        symbol = selector_count_;
      }
    }
    if (symbol >= selector_count_) return history_.use(symbol - selector_count_);
    history_.add(symbol);
    return symbol;
  }

  const Codes& codes_;
  BitReader bits_;
  uint32_t palette_count_;
  uint32_t selector_count_;
  History history_;
  /// The palettes of the blocks of the row above. Entries to the left of the next block already belong to the current
  /// row.
  std::vector<uint32_t> above_;
  std::vector<uint32_t> predictions_below_;
  uint32_t above_left_ = 0;
  uint32_t last_palette_ = 0;
  uint32_t prediction_ = 0;
  uint32_t last_prediction_ = 0;
  uint32_t prediction_run_ = 0;
  uint32_t selector_run_ = 0;
};

Bytes part_of(Bytes bytes, uint64_t place, uint64_t count) {
  if (place > bytes.size() || count > bytes.size() - place) refuse_data();
  return bytes.subspan(place, count);
}

/// The file's global data, which all its pictures share, and the positions of the slices of the largest picture.
struct Globals {
  explicit Globals(Bytes bytes) {
    const auto number_at = [&](uint64_t place, uint64_t size) {
      uint32_t number = 0;
      std::memcpy(&number, part_of(bytes, place, size).data(), size);
      return number;
    };
    constexpr uint64_t kHeadBytes = 20;
    constexpr uint64_t kImageBytes = 20;
    const uint32_t palette_count = number_at(0, 2);
    const uint32_t selector_count = number_at(2, 2);
    std::array<uint32_t, 4> lengths{};
    for (size_t i = 0; i < lengths.size(); ++i) lengths[i] = number_at(4 + 4 * i, 4);
    for (size_t i = 0; i < slices.size(); ++i) {
      slices[i] = {number_at(kHeadBytes + 4 + 8 * i, 4), number_at(kHeadBytes + 8 + 8 * i, 4)};
    }
    // The image descriptions of all levels come before the codebooks, which are the rest of the data.
    const uint64_t codebook_bytes = uint64_t{lengths[0]} + lengths[1] + lengths[2] + lengths[3];
    if (bytes.size() < kHeadBytes + kImageBytes + codebook_bytes) refuse_data();
    const uint64_t at = bytes.size() - codebook_bytes;
    palettes = read_palettes(part_of(bytes, at, lengths[0]), palette_count);
    selectors = read_selectors(part_of(bytes, at + lengths[0], lengths[1]), selector_count);
    tables = part_of(bytes, at + lengths[0] + lengths[1], lengths[2]);
  }

  std::vector<Palette> palettes;
  std::vector<Selectors> selectors;
  Bytes tables;
  /// Position and length of the slice of colours, and of the second slice.
  std::array<std::pair<uint32_t, uint32_t>, 2> slices;
};

/// Calls put(x, y, color) for each texel of a slice.
template <typename Put>
void decode_slice(const Etc1sPicture& picture, const Globals& globals, const Codes& codes, Bytes slice,
                  const Put& put) {
  const uint32_t column_count = (picture.width + 3) / 4;
  SliceReader reader(codes, slice, static_cast<uint32_t>(globals.palettes.size()),
                     static_cast<uint32_t>(globals.selectors.size()), column_count);
  for (uint32_t row = 0; 4 * row < picture.height; ++row) {
    for (uint32_t column = 0; column < column_count; ++column) {
      const auto [palette, selectors] = reader.read(row, column);
      for (uint32_t i = 0; i < 16; ++i) {
        const uint32_t x = 4 * column + i % 4;
        const uint32_t y = 4 * row + i / 4;
        if (x >= picture.width || y >= picture.height) continue;
        put(x, y, globals.palettes[palette][globals.selectors[selectors][i / 4] >> (2 * (i % 4)) & 3]);
      }
    }
  }
}

}  // namespace

void decode_etc1s(const Etc1sPicture& picture, std::span<unsigned char> pixels) {
  const Globals globals(picture.globals);
  const Codes codes = read_codes(globals.tables);
  const auto pixel_at = [&](uint32_t x, uint32_t y) { return &pixels[4 * (uint64_t{y} * picture.width + x)]; };
  const auto slice_of = [&](size_t i) {
    return part_of(picture.level, globals.slices[i].first, globals.slices[i].second);
  };
  decode_slice(picture, globals, codes, slice_of(0), [&](uint32_t x, uint32_t y, const std::array<uint8_t, 3>& color) {
    unsigned char* pixel = pixel_at(x, y);
    std::copy(color.begin(), color.end(), pixel);
    pixel[3] = 255;
  });
  if (globals.slices[1].second == 0) return;
  const size_t channel = picture.is_second_green ? 1 : 3;
  decode_slice(picture, globals, codes, slice_of(1), [&](uint32_t x, uint32_t y, const std::array<uint8_t, 3>& color) {
    unsigned char* pixel = pixel_at(x, y);
    if (picture.is_second_green) pixel[2] = 0;
    pixel[channel] = color[1];
  });
}
