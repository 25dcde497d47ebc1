// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "promin/math.h"

namespace promin {

/// Builds a binary STL file, on a little-endian machine.
class StlBuilder {
 public:
  explicit StlBuilder(std::string header = "made here") : bytes_(std::move(header)) { bytes_.resize(84, '\0'); }

  void add(const std::array<vec3, 3>& corners, uint16_t attribute = 0) {
    append(vec3(0, 0, -1));
    for (const vec3& corner : corners) append(corner);
    append(attribute);
    ++facet_count_;
    std::memcpy(bytes_.data() + 80, &facet_count_, sizeof(facet_count_));
  }

  const std::string& bytes() const { return bytes_; }

 private:
  template <class Value>
  void append(const Value& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }

  std::string bytes_;
  uint32_t facet_count_ = 0;
};

}  // namespace promin
