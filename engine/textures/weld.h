// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/hash.h"

namespace promin {

/// The attributes that distinguish vertices for tangents: position, normal and a pair of texture coordinates.
using VertexKey = std::array<float, 8>;

/// Returns for each i below `count` the lowest j whose key_of(j) equals key_of(i). The numbers 0 and -0 are equal. It
/// takes linear time.
template <typename KeyOf>
std::vector<uint32_t> weld(uint32_t count, const KeyOf& key_of) {
  constexpr uint32_t kEmpty = std::numeric_limits<uint32_t>::max();
  const uint64_t mask = std::bit_ceil(2 * uint64_t{count} + 1) - 1;
  std::vector<uint32_t> table(mask + 1, kEmpty);
  std::vector<uint32_t> first(count);
  for (uint32_t i = 0; i < count; ++i) {
    const VertexKey key = key_of(i);
    Hash64 hash;
    for (size_t k = 0; k < key.size(); k += 2) {
      hash.add(std::bit_cast<uint32_t>(key[k] + 0.0F) | uint64_t{std::bit_cast<uint32_t>(key[k + 1] + 0.0F)} << 32);
    }
    uint64_t place = hash.value() & mask;
    while (table[place] != kEmpty && key_of(table[place]) != key) place = (place + 1) & mask;
    if (table[place] == kEmpty) table[place] = i;
    first[i] = table[place];
  }
  return first;
}

}  // namespace promin
