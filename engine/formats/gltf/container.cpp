// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/container.h"

#include <cstdint>
#include <string>

namespace promin {
namespace {

constexpr uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr size_t kHeaderBytes = 12;
constexpr size_t kChunkHeaderBytes = 8;
const char* const kExportAgain = "export or copy the file again";

uint32_t read_u32(std::span<const std::byte> bytes, size_t offset) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= std::to_integer<uint32_t>(bytes[offset + i]) << (8 * i);
  return value;
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

[[noreturn]] void refuse_file(LoadReport& report, const std::string& what, const std::string& place) {
  report.refuse(what, place, kExportAgain);
  report.throw_if_refused();
  throw InputError({what, place, kExportAgain});
}

GltfContainer split_glb(std::span<const std::byte> bytes, LoadReport& report) {
  if (bytes.size() < kHeaderBytes + kChunkHeaderBytes) refuse_file(report, "the GLB header is cut off", "byte 0");
  const uint32_t version = read_u32(bytes, 4);
  if (version != 2) refuse_file(report, "GLB version " + std::to_string(version) + " is not 2", "byte 4");
  const uint32_t length = read_u32(bytes, 8);
  if (length > bytes.size() || length < kHeaderBytes + kChunkHeaderBytes) {
    refuse_file(
        report,
        "the GLB header promises " + std::to_string(length) + " bytes, the file has " + std::to_string(bytes.size()),
        "byte 8");
  }

  if (length < bytes.size()) {
    report.warn("the " + std::to_string(bytes.size() - length) + " bytes after the end of the GLB are ignored");
    bytes = bytes.first(length);
  }

  GltfContainer container;
  bool is_first = true;
  for (size_t offset = kHeaderBytes; offset < bytes.size();) {
    const std::string place = "byte " + std::to_string(offset);
    if (bytes.size() - offset < kChunkHeaderBytes) refuse_file(report, "a GLB chunk header is cut off", place);
    const size_t chunk_length = read_u32(bytes, offset);
    const uint32_t chunk_type = read_u32(bytes, offset + 4);
    offset += kChunkHeaderBytes;
    if (chunk_length > bytes.size() - offset) {
      refuse_file(report,
                  "a GLB chunk promises " + std::to_string(chunk_length) + " bytes, " +
                      std::to_string(bytes.size() - offset) + " are left",
                  place);
    }
    const auto chunk = bytes.subspan(offset, chunk_length);
    offset += chunk_length;
    if (is_first != (chunk_type == kJsonChunk)) refuse_file(report, "the first GLB chunk alone must be JSON", place);
    if (is_first) container.json = as_text(chunk);
    if (chunk_type == kBinaryChunk && !container.binary) container.binary = chunk;
    is_first = false;
  }
  return container;
}

}  // namespace

GltfContainer split_gltf(std::span<const std::byte> bytes, LoadReport& report) {
  const bool is_glb = bytes.size() >= 4 && read_u32(bytes, 0) == kMagic;
  return is_glb ? split_glb(bytes, report) : GltfContainer{as_text(bytes), std::nullopt};
}

}  // namespace promin
