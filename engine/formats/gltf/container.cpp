// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/container.h"

#include <algorithm>
#include <cstdint>
#include <string>

namespace promin {
namespace {

constexpr uint32_t kGlbMagic = 0x46546C67;     // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr size_t kGlbHeaderBytes = 12;
constexpr size_t kChunkHeaderBytes = 8;
constexpr size_t kMostChunkPadding = 3;
const char* const kExportAgain = "export or copy the file again";

uint32_t read_glb_word(std::span<const std::byte> bytes, size_t offset) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= std::to_integer<uint32_t>(bytes[offset + i]) << (8 * i);
  return value;
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

[[noreturn]] void refuse_file(ProblemCode code, LoadReport& report, const std::string& what, const std::string& place) {
  report.refuse(code, what, place, kExportAgain);
  report.throw_if_refused();
  throw InputError({code, what, place, kExportAgain});
}

/// Checks that the length in the header equals the end of the chunks.
void check_length(size_t length, size_t end, size_t size, LoadReport& report) {
  if (length != end) {
    report.repair({"glb.length", "the length in the GLB header differs from the length of the chunks",
                   std::to_string(length) + " and " + std::to_string(end) + " bytes", "byte 8", kExportAgain,
                   "the chunks are read"});
  }
  if (end < size) report.warn("the " + std::to_string(size - end) + " bytes after the end of the GLB are ignored");
}

uint32_t read_length(std::span<const std::byte> bytes, LoadReport& report) {
  if (bytes.size() < kGlbHeaderBytes + kChunkHeaderBytes)
    refuse_file("glb.short", report, "the GLB header is incomplete", "byte 0");
  const uint32_t version = read_glb_word(bytes, 4);
  if (version == 1) {
    report.refuse("gltf.version", "the file is glTF 1.0, which promin does not read", "byte 4",
                  "export it as glTF 2.0");
    report.throw_if_refused();
  }
  if (version != 2)
    refuse_file("gltf.version", report,
                "the GLB version is " + std::to_string(version) + ", but promin reads only version 2", "byte 4");
  return read_glb_word(bytes, 8);
}

/// Returns the bytes of the chunk whose header ends at `offset`. Some exporters count bytes of padding that they do not
/// write.
std::span<const std::byte> take_chunk(std::span<const std::byte> bytes, size_t offset, size_t length,
                                      const std::string& place, LoadReport& report) {
  const size_t left = bytes.size() - offset;
  if (length <= left) return bytes.subspan(offset, length);
  const std::string what =
      "a GLB chunk declares " + std::to_string(length) + " bytes, but only " + std::to_string(left) + " bytes remain";
  if (length - left > kMostChunkPadding) refuse_file("glb.short", report, what, place);
  report.repair({"glb.short", "a GLB chunk extends beyond the end of the file",
                 std::to_string(length - left) + " bytes", place, kExportAgain, "the existing part is read"});
  return bytes.subspan(offset);
}

GltfContainer split_glb(std::span<const std::byte> bytes, LoadReport& report) {
  const size_t length = read_length(bytes, report);
  const size_t end = length < kGlbHeaderBytes + kChunkHeaderBytes ? bytes.size() : std::min(length, bytes.size());
  GltfContainer container;
  bool is_first = true;
  size_t offset = kGlbHeaderBytes;
  // The header's length is the end of the chunks. Each chunk has its own length.
  while (offset < end) {
    const std::string place = "byte " + std::to_string(offset);
    if (end - offset < kChunkHeaderBytes) {
      report.repair({"glb.short", "a GLB chunk header is cut off", "", place, kExportAgain, "the bytes are ignored"});
      offset = end;
      break;
    }
    const uint32_t chunk_type = read_glb_word(bytes, offset + 4);
    const size_t chunk_length = read_glb_word(bytes, offset);
    offset += kChunkHeaderBytes;
    const auto chunk = take_chunk(bytes, offset, chunk_length, place, report);
    offset += chunk_length;
    if (is_first && chunk_type != kJsonChunk)
      refuse_file("glb.chunks", report, "the first GLB chunk is not JSON", place);
    if (!is_first && chunk_type == kJsonChunk) {
      report.repair({"glb.chunks", "a second GLB chunk is JSON", "", place, kExportAgain, "promin ignores it"});
    }
    if (is_first) container.json = as_text(chunk);
    if (chunk_type == kBinaryChunk && !container.binary) container.binary = chunk;
    is_first = false;
  }
  check_length(length, offset, bytes.size(), report);
  return container;
}

}  // namespace

GltfContainer split_gltf(std::span<const std::byte> bytes, LoadReport& report) {
  const bool is_glb = bytes.size() >= 4 && read_glb_word(bytes, 0) == kGlbMagic;
  return is_glb ? split_glb(bytes, report) : GltfContainer{as_text(bytes), std::nullopt};
}

}  // namespace promin
