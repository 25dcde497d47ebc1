// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>

/// Takes bits off bytes, of each byte the lowest first.
class BitReader {
 public:
  explicit BitReader(std::span<const unsigned char> bytes) : bytes_(bytes) {}

  /// Up to 32 bits as a number whose lowest bit comes first. Throws std::runtime_error past the end.
  uint32_t take(uint32_t count) {
    uint32_t bits = 0;
    for (uint32_t i = 0; i < count; ++i, ++place_) {
      if (place_ / 8 >= bytes_.size()) throw std::runtime_error("its bits end too early");
      bits |= static_cast<uint32_t>(bytes_[place_ / 8] >> place_ % 8 & 1) << i;
    }
    return bits;
  }

 private:
  std::span<const unsigned char> bytes_;
  uint64_t place_ = 0;
};
