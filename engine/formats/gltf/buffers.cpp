// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/buffers.h"

#include <array>
#include <cstdint>

#include "core/file.h"
#include "formats/gltf/json_lookup.h"
#include "formats/scene_path.h"

namespace promin {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::byte>;

constexpr std::array<int8_t, 256> make_base64_values() {
  std::array<int8_t, 256> values{};
  values.fill(-1);
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < kAlphabet.size(); ++i) {
    values[static_cast<unsigned char>(kAlphabet[i])] = static_cast<int8_t>(i);
  }
  return values;
}

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// The readers below return nullopt once the report holds the reason.

std::optional<Bytes> read_data_uri(const std::string& uri, const std::string& place, LoadReport& report) {
  constexpr std::string_view kMarker = ";base64,";
  const size_t marker = uri.find(kMarker);
  if (marker == std::string::npos || uri.find(',') != marker + kMarker.size() - 1) {
    report.refuse("the data: URI is not base64", place, "write data:application/octet-stream;base64,...");
    return std::nullopt;
  }
  std::optional<Bytes> bytes = decode_base64(std::string_view(uri).substr(marker + kMarker.size()));
  if (!bytes) report.refuse("the data: URI holds broken base64", place, "export the file again");
  return bytes;
}

std::optional<Bytes> read_uri(const std::string& uri, const std::string& place, LoadReport& report) {
  if (uri.starts_with("data:")) return read_data_uri(uri, place, report);
  const std::optional<std::string> name = decode_percent(uri);
  if (!name) {
    report.refuse("the URI holds a broken percent escape", place, "write % as %25");
    return std::nullopt;
  }
  const auto file = find_beside_scene(*name, place, true, report);
  if (!file) return std::nullopt;
  return read_file(*file);
}

std::optional<Bytes> read_buffer(const json& buffer, const std::string& place,
                                 std::optional<std::span<const std::byte>> glb_binary, LoadReport& report) {
  if (buffer.contains("uri")) return read_uri(buffer["uri"], place + ".uri", report);
  if (glb_binary) return Bytes(glb_binary->begin(), glb_binary->end());
  report.refuse("the buffer has no bytes", place, "add a uri, or a binary chunk to the GLB file");
  return std::nullopt;
}

}  // namespace

std::optional<Bytes> decode_base64(std::string_view text) {
  static constexpr std::array<int8_t, 256> kValues = make_base64_values();
  for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    const int value = kValues[static_cast<unsigned char>(c)];
    if (value < 0) return std::nullopt;
    bits = (bits << 6) | static_cast<uint32_t>(value);
    bit_count += 6;
    if (bit_count >= 8) {
      bit_count -= 8;
      bytes.push_back(static_cast<std::byte>((bits >> bit_count) & 0xFF));
    }
  }
  return bytes;
}

std::optional<std::string> decode_percent(std::string_view text) {
  std::string decoded;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    if (i + 2 >= text.size() || hex_value(text[i + 1]) < 0 || hex_value(text[i + 2]) < 0) return std::nullopt;
    decoded += static_cast<char>(16 * hex_value(text[i + 1]) + hex_value(text[i + 2]));
    i += 2;
  }
  return decoded;
}

std::vector<Bytes> read_gltf_buffers(const json& document, std::optional<std::span<const std::byte>> glb_binary,
                                     LoadReport& report) {
  std::vector<Bytes> buffers;
  for (const json& buffer : elements_of(document, "buffers")) {
    const std::string place = "buffers[" + std::to_string(buffers.size()) + "]";
    // The binary chunk belongs to the first buffer alone.
    std::optional<Bytes> bytes = read_buffer(buffer, place, buffers.empty() ? glb_binary : std::nullopt, report);
    const auto length = buffer["byteLength"].get<uint64_t>();
    if (bytes && bytes->size() < length) {
      report.refuse("the buffer has " + std::to_string(bytes->size()) + " bytes, less than its byteLength of " +
                        std::to_string(length),
                    place, "export the file again");
    }
    buffers.push_back(std::move(bytes).value_or(Bytes{}));
  }
  return buffers;
}

}  // namespace promin
