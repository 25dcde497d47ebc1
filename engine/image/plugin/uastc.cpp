// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/uastc.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "image/plugin/bit_reader.h"

namespace {

[[noreturn]] void refuse_block() {
  throw std::runtime_error("a UASTC block is damaged");
}

/// The storage of the numbers of endpoints: one digit to the base three or five, and bits. The letters say where these
/// bits go when the number is converted to 8 bits (Khronos Data Format Specification, "Endpoint unquantization"; the
/// lowest bit is always "a").
struct Range {
  uint32_t base;
  uint32_t bits;
  std::string_view spread;
  uint32_t factor;
};
constexpr Range kBits4 = {1, 4, "", 0};
constexpr Range kBits5 = {1, 5, "", 0};
constexpr Range kBits8 = {1, 8, "", 0};
constexpr Range kTritBits2 = {3, 2, "b000b0bb0", 93};
constexpr Range kTritBits4 = {3, 4, "dcb000dcb", 22};
constexpr Range kTritBits6 = {3, 6, "fedcb000f", 5};
constexpr Range kQuintBits3 = {5, 3, "cb0000cbc", 26};
constexpr Range kQuintBits5 = {5, 5, "edcb0000e", 6};

enum class Channels : uint32_t { kLuminanceAlpha = 2, kRgb = 3, kRgba = 4 };

/// A kind of block. Such a block begins with hints for other formats, which are skipped.
struct Mode {
  uint32_t code;
  uint32_t code_bits;
  Channels channels;
  Range endpoints;
  uint32_t weight_bits;
  uint32_t planes;
  uint32_t subsets;
  uint32_t hint_bits;
};
constexpr size_t kModeOfPatterns23 = 7;
constexpr size_t kSolid = 8;
constexpr std::array<Mode, 19> kModes = {{{1, 4, Channels::kRgb, kTritBits6, 4, 1, 1, 15},
                                          {53, 6, Channels::kRgb, kBits8, 2, 1, 1, 15},
                                          {29, 5, Channels::kRgb, kBits4, 3, 1, 2, 15},
                                          {3, 5, Channels::kRgb, kTritBits2, 2, 1, 3, 15},
                                          {19, 5, Channels::kRgb, kQuintBits3, 2, 1, 2, 15},
                                          {11, 5, Channels::kRgb, kBits8, 3, 1, 1, 15},
                                          {27, 5, Channels::kRgb, kQuintBits5, 2, 2, 1, 15},
                                          {7, 5, Channels::kRgb, kQuintBits3, 2, 1, 2, 15},
                                          {23, 5, Channels::kRgba, kBits8, 0, 0, 0, 0},
                                          {15, 5, Channels::kRgba, kBits4, 2, 1, 2, 23},
                                          {2, 3, Channels::kRgba, kTritBits4, 4, 1, 1, 17},
                                          {0, 2, Channels::kRgba, kTritBits4, 2, 2, 1, 17},
                                          {6, 3, Channels::kRgba, kTritBits6, 3, 1, 1, 17},
                                          {31, 5, Channels::kRgba, kBits8, 1, 2, 1, 23},
                                          {13, 5, Channels::kRgba, kBits8, 2, 1, 1, 23},
                                          {5, 7, Channels::kLuminanceAlpha, kBits8, 4, 1, 1, 23},
                                          {21, 6, Channels::kLuminanceAlpha, kBits8, 2, 1, 2, 23},
                                          {37, 6, Channels::kLuminanceAlpha, kBits8, 2, 2, 1, 23},
                                          {9, 4, Channels::kRgb, kBits5, 5, 1, 1, 15}}};

/// For each pattern of two subsets, the subset of each texel; the first texel is the lowest bit.
constexpr auto kPatterns2 =
    std::to_array<uint16_t>({0xCCCC, 0x8888, 0x1111, 0xECC8, 0x377F, 0xFEEC, 0x0137, 0x137F, 0xC800, 0x0013,
                             0xFE80, 0x17FF, 0x0017, 0x00FF, 0xFFF0, 0x0FFF, 0xFF71, 0x8EFF, 0x08CE, 0x008C,
                             0x7310, 0xCEFF, 0x7331, 0x088C, 0xCEEF, 0x6666, 0xF00F, 0x5555, 0x0F0F, 0x36C9});
/// The patterns of two subsets in mode 7.
constexpr auto kPatterns23 =
    std::to_array<uint16_t>({0x00F0, 0x4444, 0x0133, 0xCC80, 0xF0FF, 0x2222, 0xFFC8, 0xCCCE, 0x3C03, 0x00EE, 0x7700,
                             0x3003, 0x00CE, 0xFF80, 0x6FFF, 0x1333, 0x11FF, 0x136C, 0x00EF});
/// For each pattern of three subsets, the subset of each texel, with two bits for each texel.
constexpr auto kPatterns3 =
    std::to_array<uint32_t>({0xA5A50000, 0xAA005555, 0xAA000055, 0x0000AA55, 0x25252525, 0x94949494, 0x58585858,
                             0x56560202, 0x92929292, 0x55AA0055, 0xA05050A0});

constexpr size_t kTexels = 16;
using Subsets = std::array<uint8_t, kTexels>;

size_t read_mode(BitReader& bits) {
  uint32_t code = 0;
  for (uint32_t length = 1; length <= 7; ++length) {
    code |= bits.take(1) << (length - 1);
    const auto is_it = [&](const Mode& mode) { return mode.code_bits == length && mode.code == code; };
    const auto* const mode = std::ranges::find_if(kModes, is_it);
    if (mode != kModes.end()) return static_cast<size_t>(mode - kModes.begin());
  }
  refuse_block();
}

template <typename Patterns>
Subsets unpack_pattern(const Patterns& patterns, uint32_t index, uint32_t bits_of_texel) {
  if (index >= patterns.size()) refuse_block();
  Subsets subsets{};
  const uint32_t mask = (1U << bits_of_texel) - 1;
  for (uint32_t i = 0; i < kTexels; ++i) {
    subsets[i] = static_cast<uint8_t>(uint32_t{patterns[index]} >> (bits_of_texel * i) & mask);
  }
  return subsets;
}

Subsets read_subsets(BitReader& bits, size_t mode) {
  if (kModes[mode].subsets == 1) return {};
  if (kModes[mode].subsets == 3) return unpack_pattern(kPatterns3, bits.take(4), 2);
  const uint32_t index = bits.take(5);
  return mode == kModeOfPatterns23 ? unpack_pattern(kPatterns23, index, 1) : unpack_pattern(kPatterns2, index, 1);
}

uint8_t to_8_bits(const Range& range, uint32_t digit, uint32_t stored) {
  if (range.base == 1) {
    uint32_t value = 0;
    for (int shift = 8 - static_cast<int>(range.bits); shift > -static_cast<int>(range.bits);
         shift -= static_cast<int>(range.bits)) {
      value |= shift >= 0 ? stored << shift : stored >> -shift;
    }
    return static_cast<uint8_t>(value);
  }
  const uint32_t flip = (stored & 1) != 0 ? 511 : 0;
  uint32_t spread = 0;
  for (const char letter : range.spread) {
    spread = spread << 1 | (letter == '0' ? 0 : stored >> (letter - 'a') & 1);
  }
  const uint32_t value = (digit * range.factor + spread) ^ flip;
  return static_cast<uint8_t>((flip & 0x80) | value >> 2);
}

/// Reads numbers of 8 bits. The digits come first, several packed into few bits, and then the bits of all numbers.
std::vector<uint8_t> read_endpoints(BitReader& bits, const Range& range, size_t count) {
  constexpr std::array<uint32_t, 6> kBitsOfTrits = {0, 2, 4, 5, 7, 8};
  constexpr std::array<uint32_t, 4> kBitsOfQuints = {0, 3, 5, 7};
  const size_t group = range.base == 3 ? 5 : 3;
  std::vector<uint32_t> digits(count);
  for (size_t first = 0; range.base > 1 && first < count; first += group) {
    const size_t size = std::min(group, count - first);
    uint32_t packed = bits.take(range.base == 3 ? kBitsOfTrits[size] : kBitsOfQuints[size]);
    for (size_t i = 0; i < size; ++i, packed /= range.base) digits[first + i] = packed % range.base;
  }
  std::vector<uint8_t> numbers;
  for (const uint32_t digit : digits) numbers.push_back(to_8_bits(range, digit, bits.take(range.bits)));
  return numbers;
}

/// Returns the weight of the second endpoint, in 64ths.
uint32_t weight_of(uint32_t stored, uint32_t bits) {
  const uint32_t most = (1U << bits) - 1;
  // ASTC repeats the bits until there are six, and adds 1 to values in the upper half.
  uint32_t six = 0;
  for (int shift = 6 - static_cast<int>(bits); shift > -static_cast<int>(bits); shift -= static_cast<int>(bits)) {
    six |= shift >= 0 ? stored << shift : stored >> -shift;
  }
  return stored == most ? 64 : six + (six > 32 ? 1 : 0);
}

/// Reads the weight of each texel in each plane. The highest bit of the first texel of each subset is not stored; it is
/// 0.
std::array<std::array<uint32_t, 2>, kTexels> read_weights(BitReader& bits, const Mode& mode, const Subsets& subsets) {
  std::array<std::array<uint32_t, 2>, kTexels> weights{};
  for (size_t i = 0; i < kTexels; ++i) {
    const bool is_first = std::find(subsets.begin(), subsets.end(), subsets[i]) == subsets.begin() + i;
    for (size_t plane = 0; plane < mode.planes; ++plane) {
      weights[i][plane] = weight_of(bits.take(mode.weight_bits - (is_first ? 1 : 0)), mode.weight_bits);
    }
  }
  return weights;
}

uint8_t interpolate(uint32_t from, uint32_t to, uint32_t weight) {
  return static_cast<uint8_t>(((257 * from * (64 - weight) + 257 * to * weight + 32) >> 6) >> 8);
}

/// Returns the position of a channel's two numbers among the numbers of a subset. An alpha of 1 has no numbers.
size_t place_of_channel(Channels channels, size_t channel) {
  if (channels == Channels::kLuminanceAlpha) return channel == 3 ? 2 : 0;
  return 2 * channel;
}

}  // namespace

std::array<std::array<uint8_t, 4>, 16> decode_uastc(std::span<const unsigned char, 16> block) {
  BitReader bits(block);
  const size_t number = read_mode(bits);
  const Mode& mode = kModes[number];
  std::array<std::array<uint8_t, 4>, 16> texels{};
  if (number == kSolid) {
    for (uint8_t& channel : texels[0]) channel = static_cast<uint8_t>(bits.take(8));
    texels.fill(texels[0]);
    return texels;
  }
  bits.take(mode.hint_bits);
  const bool chooses_channel = mode.planes == 2 && mode.channels != Channels::kLuminanceAlpha;
  const size_t second_plane = chooses_channel ? bits.take(2) : 3;
  const Subsets subsets = read_subsets(bits, number);
  const size_t numbers_of_subset = 2 * static_cast<size_t>(mode.channels);
  const std::vector<uint8_t> endpoints = read_endpoints(bits, mode.endpoints, mode.subsets * numbers_of_subset);
  const auto weights = read_weights(bits, mode, subsets);
  for (size_t i = 0; i < kTexels; ++i) {
    const uint8_t* of_subset = &endpoints[subsets[i] * numbers_of_subset];
    for (size_t channel = 0; channel < 4; ++channel) {
      const size_t place = place_of_channel(mode.channels, channel);
      const uint32_t weight = weights[i][mode.planes == 2 && channel == second_plane ? 1 : 0];
      texels[i][channel] =
          place < numbers_of_subset ? interpolate(of_subset[place], of_subset[place + 1], weight) : uint8_t{255};
    }
  }
  return texels;
}
