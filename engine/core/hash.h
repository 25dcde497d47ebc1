// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace promin {

/// An integer hash (Wellons, "Prospecting for Hash Functions", lowbias32).
inline uint32_t mix_bits(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7FEB352DU;
  x ^= x >> 15;
  x *= 0x846CA68BU;
  return x ^ x >> 16;
}

/// A 64-bit checksum over words of 8 bytes. Each word is mixed in with an xor, a multiplication by an odd number and a
/// shift. Each step is a bijection, so data that differ in a single word never have the same checksum. The checksum
/// does not protect against deliberate changes.
class Hash64 {
 public:
  void add(uint64_t word) {
    state_ = (state_ ^ word) * kMultiplier;
    state_ ^= state_ >> 32;
  }
  /// An incomplete last word is padded with zeros.
  void add(std::span<const std::byte> bytes) {
    for (size_t i = 0; i < bytes.size(); i += sizeof(uint64_t)) {
      uint64_t word = 0;
      std::memcpy(&word, bytes.data() + i, bytes.size() - i < sizeof(word) ? bytes.size() - i : sizeof(word));
      add(word);
    }
  }
  uint64_t value() const { return state_; }

 private:
  /// 2^64 divided by the golden ratio: a number whose bits have no pattern.
  static constexpr uint64_t kMultiplier = 0x9E3779B97F4A7C15;

  uint64_t state_ = kMultiplier;
};

}  // namespace promin
