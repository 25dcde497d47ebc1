// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

namespace promin {

/// Builds a binary PLY file.
class PlyBuilder {
 public:
  explicit PlyBuilder(std::endian order) : order_(order) {}

  /// Writes the header. `elements` are the "element" lines and their properties.
  void header(const std::string& elements) {
    const std::string order = order_ == std::endian::little ? "little" : "big";
    bytes_ += "ply\nformat binary_" + order + "_endian 1.0\n" + elements + "end_header\n";
  }

  /// Appends a number of the PLY type with this name.
  void add(const std::string& type, double number) {
    if (type == "char" || type == "int8") return append(static_cast<int8_t>(number));
    if (type == "uchar" || type == "uint8") return append(static_cast<uint8_t>(number));
    if (type == "short" || type == "int16") return append(static_cast<int16_t>(number));
    if (type == "ushort" || type == "uint16") return append(static_cast<uint16_t>(number));
    if (type == "int" || type == "int32") return append(static_cast<int32_t>(number));
    if (type == "uint" || type == "uint32") return append(static_cast<uint32_t>(number));
    if (type == "float" || type == "float32") return append(static_cast<float>(number));
    append(number);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  template <class Number>
  void append(Number number) {
    std::string bytes(sizeof(Number), '\0');
    std::memcpy(bytes.data(), &number, sizeof(Number));
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    bytes_ += bytes;
  }

  std::endian order_;
  std::string bytes_;
};

}  // namespace promin
