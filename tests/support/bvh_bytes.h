// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "core/hash.h"

namespace promin {

// Offsets of fields in the header (docs/bvh_file.md).
inline constexpr size_t kByteOrderPlace = 8;
inline constexpr size_t kVersionPlace = 12;
inline constexpr size_t kChecksumPlace = 16;
inline constexpr size_t kLayoutHashPlace = 24;
inline constexpr size_t kNodeCountPlace = 40;
inline constexpr size_t kReferenceCountPlace = 44;
inline constexpr size_t kPrimitiveCountPlace = 48;
inline constexpr size_t kBuilderPlace = 88;
inline constexpr size_t kHeaderSize = 128;

/// The bytes of a BVH file.
using Bytes = std::vector<std::byte>;

template <typename T>
Bytes with(Bytes bytes, size_t place, const T& value) {
  std::memcpy(bytes.data() + place, &value, sizeof(T));
  return bytes;
}

/// Returns the bytes with the checksum of their content.
inline Bytes sealed(Bytes bytes) {
  bytes = with(std::move(bytes), kChecksumPlace, uint64_t{0});
  Hash64 hash;
  hash.add(bytes);
  return with(std::move(bytes), kChecksumPlace, hash.value());
}

}  // namespace promin
