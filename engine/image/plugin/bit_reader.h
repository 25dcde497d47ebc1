// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>

/// Reads bits from bytes, the lowest bit of each byte first.
class BitReader {
 public:
  explicit BitReader(std::span<const unsigned char> bytes) : bytes_(bytes) {}

  /// Returns up to 32 bits as a number whose lowest bit comes first. Throws std::runtime_error after the end.
  uint32_t take(uint32_t count) {
    if (place_ + count > 8 * bytes_.size()) throw std::runtime_error("its bits end too early");
    uint32_t bits = 0;
    for (uint32_t taken = 0; taken < count;) {
      const auto offset = static_cast<uint32_t>(place_ % 8);
      const uint32_t part = std::min(count - taken, 8 - offset);
      bits |= (bytes_[place_ / 8] >> offset & ((1U << part) - 1)) << taken;
      taken += part;
      place_ += part;
    }
    return bits;
  }

 private:
  std::span<const unsigned char> bytes_;
  uint64_t place_ = 0;
};
