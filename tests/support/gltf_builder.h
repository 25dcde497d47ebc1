// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace promin {

inline std::string encode_base64(std::string_view bytes) {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) {
      bits = (bits << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kAlphabet[(bits >> (18 - 6 * k)) & 63] : '=';
  }
  return text;
}

/// A glTF document under construction: change `json` freely, add numbers by add().
struct GltfBuilder {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  std::string bytes;

  /// Appends an accessor of these tightly packed numbers. Returns its index.
  template <class Number>
  size_t add(const std::vector<Number>& numbers, const std::string& type, bool normalized = false) {
    constexpr int kType = std::is_same_v<Number, int8_t>     ? 5120
                          : std::is_same_v<Number, uint8_t>  ? 5121
                          : std::is_same_v<Number, int16_t>  ? 5122
                          : std::is_same_v<Number, uint16_t> ? 5123
                          : std::is_same_v<Number, uint32_t> ? 5125
                                                             : 5126;
    const size_t rows = type == "SCALAR" ? 1 : static_cast<size_t>(type.back() - '0');
    const size_t components = type.starts_with("MAT") ? rows * rows : rows;
    json["accessors"].push_back({{"bufferView", add_view(numbers)},
                                 {"componentType", kType},
                                 {"count", numbers.size() / components},
                                 {"type", type},
                                 {"normalized", normalized}});
    return json["accessors"].size() - 1;
  }

  /// Appends the numbers as a buffer view. Returns its index.
  template <class Number>
  size_t add_view(const std::vector<Number>& numbers) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const size_t length = numbers.size() * sizeof(Number);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", length}});
    bytes.append(reinterpret_cast<const char*>(numbers.data()), length);
    return json["bufferViews"].size() - 1;
  }

  /// Appends a mesh of one primitive and a root node with it. Returns the node's index.
  size_t show(const nlohmann::json& primitive) {
    json["meshes"].push_back({{"primitives", {primitive}}});
    return add_node({{"mesh", json["meshes"].size() - 1}});
  }

  size_t add_node(const nlohmann::json& node) {
    json["nodes"].push_back(node);
    return json["nodes"].size() - 1;
  }

  std::string text() {
    if (!bytes.empty()) {
      json["buffers"] = {
          {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + encode_base64(bytes)}}};
    }
    return json.dump();
  }

  std::string glb() {
    if (!bytes.empty()) json["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string head = json.dump();
    head.resize((head.size() + 3) / 4 * 4, ' ');
    std::string binary = bytes;
    binary.resize((binary.size() + 3) / 4 * 4);
    std::string file = "glTF" + u32(2) + u32(12 + 8 + head.size() + 8 + binary.size());
    return file + u32(head.size()) + "JSON" + head + u32(binary.size()) + std::string("BIN\0", 4) + binary;
  }

  static std::string u32(size_t value) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += static_cast<char>((value >> (8 * i)) & 0xFF);
    return text;
  }
};

/// Returns a document with one triangle, (0,0,0) (1,0,0) (0,1,0), at node 0.
inline GltfBuilder triangle_gltf() {
  GltfBuilder gltf;
  const size_t positions = gltf.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const size_t indices = gltf.add<uint16_t>({0, 1, 2}, "SCALAR");
  gltf.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  return gltf;
}

}  // namespace promin
