// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/meshopt.h"

#include <meshoptimizer.h>

#include <string>

#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::byte>;

/// The largest ratio of decompressed to compressed bytes. In version 0, four bytes of a stream of attributes may stand
/// for 256 bytes; in other streams they stand for less.
constexpr uint64_t kMaxRatio = 64;
/// The largest ratio in version 1, where two bits may stand for 256 bytes.
constexpr uint64_t kMaxRatioOfVersion1 = 1024;

/// The first byte of a stream: the upper half is the kind, the lower half the version.
constexpr unsigned kAttributesHeader = 0xA0;

/// A compressed view whose data has been checked.
struct Stream {
  uint64_t offset = 0;
  uint64_t length = 0;
  uint64_t stride = 0;
  uint64_t count = 0;
  std::string mode;
  std::string filter;

  uint64_t decoded_bytes() const { return count * stride; }
};

Stream stream_of(const json& extension) {
  return {extension.value("byteOffset", uint64_t{0}),
          extension["byteLength"],
          extension["byteStride"],
          extension["count"],
          extension["mode"],
          extension.value("filter", "NONE")};
}

std::string place_of(size_t view) {
  return "bufferViews[" + std::to_string(view) + "]";
}

/// Returns the fault in the stride of the elements, or null.
const char* find_wrong_stride(const Stream& stream) {
  if (stream.mode != "ATTRIBUTES") {
    if (stream.stride != 2 && stream.stride != 4) return "the stride of indices is neither 2 nor 4";
    if (stream.filter != "NONE") return "indices have no filter";
    if (stream.mode == "TRIANGLES" && stream.count % 3 != 0) return "triangles have three indices each";
    return nullptr;
  }
  if (stream.stride % 4 != 0 || stream.stride > 256)
    return "the stride of attributes is not a multiple of 4 from 4 to 256";
  if (stream.filter == "OCTAHEDRAL" && stream.stride != 4 && stream.stride != 8) {
    return "the stride for the octahedral filter is neither 4 nor 8";
  }
  if (stream.filter == "QUATERNION" && stream.stride != 8) return "the stride for the filter of quaternions is not 8";
  return nullptr;
}

void check_packed_view(const json& document, size_t index, LoadReport& report) {
  const json& view = document["bufferViews"][index];
  const json* extension = find_meshopt(view);
  if (extension == nullptr) return;
  const Stream stream = stream_of(*extension);
  const auto available = document["buffers"][(*extension)["buffer"].get<size_t>()]["byteLength"].get<uint64_t>();
  if (stream.offset + stream.length > available) {
    report.refuse("gltf.meshopt.short",
                  "the compressed bytes end at byte " + std::to_string(stream.offset + stream.length) +
                      " of a buffer of " + std::to_string(available) + " bytes",
                  place_of(index), "correct their byteOffset or byteLength");
  }
  if (const char* wrong = find_wrong_stride(stream))
    report.refuse("gltf.meshopt.stride", wrong, place_of(index), "compress the file again");
  // The product does not overflow in 64 bits: the schema keeps counts below 2^31 and strides below 257.
  if (const auto length = view["byteLength"].get<uint64_t>(); length != stream.decoded_bytes()) {
    report.refuse("gltf.meshopt.count",
                  "the view has " + std::to_string(length) + " bytes, but its stream has " +
                      std::to_string(stream.count) + " elements of " + std::to_string(stream.stride) + " bytes",
                  place_of(index), "compress the file again");
  }
}

void apply_filter(const Stream& stream, Bytes& bytes) {
  if (stream.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), stream.count, stream.stride);
  if (stream.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), stream.count, stream.stride);
  if (stream.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), stream.count, stream.stride);
}

bool decode_stream(const Stream& stream, std::span<const std::byte> compressed, Bytes& bytes) {
  const auto* source = reinterpret_cast<const unsigned char*>(compressed.data());
  const size_t size = compressed.size();
  if (stream.mode == "TRIANGLES") {
    return meshopt_decodeIndexBuffer(bytes.data(), stream.count, stream.stride, source, size) == 0;
  }
  if (stream.mode == "INDICES") {
    return meshopt_decodeIndexSequence(bytes.data(), stream.count, stream.stride, source, size) == 0;
  }
  if (meshopt_decodeVertexBuffer(bytes.data(), stream.count, stream.stride, source, size) != 0) return false;
  apply_filter(stream, bytes);
  return true;
}

/// Decodes the views of one document.
class Decoder {
 public:
  Decoder(GltfDocument& document, LoadReport& report) : document_(document), report_(report) {
    for (const std::span<const std::byte> bytes : document.buffers.bytes) room_ += kMaxRatio * bytes.size();
  }

  void decode_view(size_t index, const json& extension) {
    const Stream stream = stream_of(extension);
    const std::span<const std::byte> compressed =
        document_.buffers.bytes[extension["buffer"].get<size_t>()].subspan(stream.offset, stream.length);
    const bool is_later_version = stream.mode == "ATTRIBUTES" && compressed[0] != std::byte{kAttributesHeader} &&
                                  (compressed[0] & std::byte{0xF0}) == std::byte{kAttributesHeader};
    if (!has_room_for(stream, is_later_version, index)) return;
    Bytes bytes(stream.decoded_bytes());
    if (!decode_stream(stream, compressed, bytes)) {
      return refuse("gltf.meshopt.damaged",
                    is_later_version
                        ? "the compressed bytes are damaged, or their version is unknown to this libmeshoptimizer: " +
                              std::to_string(static_cast<unsigned>(compressed[0]) - kAttributesHeader)
                        : "the compressed bytes are damaged",
                    index);
    }
    GltfBufferView& view = document_.views[index];
    view.buffer = static_cast<int>(document_.buffers.bytes.size());
    view.byte_offset = 0;
    document_.buffers.bytes.emplace_back(document_.buffers.own.emplace_back(std::move(bytes)));
  }

 private:
  /// Returns whether there is space for a stream; checked before memory is allocated. A file may use one stream many
  /// times, so the total is also compared with the size of the file.
  bool has_room_for(const Stream& stream, bool is_later_version, size_t index) {
    const uint64_t ratio = is_later_version ? kMaxRatioOfVersion1 : kMaxRatio;
    const uint64_t wanted = stream.decoded_bytes();
    if (wanted > ratio * stream.length) {
      refuse("gltf.meshopt.ratio",
             std::to_string(stream.length) + " compressed bytes are too few for " + std::to_string(wanted) +
                 " bytes of data",
             index);
      return false;
    }
    if (wanted > room_) {
      refuse(
          "gltf.meshopt.ratio",
          "all compressed views together expand to more than " + std::to_string(kMaxRatio) + " times the file's bytes",
          index);
      return false;
    }
    room_ -= wanted;
    return true;
  }

  void refuse(ProblemCode code, const std::string& what, size_t index) {
    report_.refuse(code, what, place_of(index), "compress the file again");
  }

  GltfDocument& document_;
  LoadReport& report_;
  uint64_t room_ = 0;
};

}  // namespace

const json* find_meshopt(const json& view) {
  const json* extension = find_extension(view, "EXT_meshopt_compression");
  return extension != nullptr ? extension : find_extension(view, "KHR_meshopt_compression");
}

void check_gltf_meshopt(const json& document, LoadReport& report) {
  for (size_t i = 0; i < elements_of(document, "bufferViews").size(); ++i) check_packed_view(document, i, report);
}

void decode_gltf_meshopt(GltfDocument& document, const std::vector<bool>& is_needed_view, LoadReport& report) {
  Decoder decoder(document, report);
  for (size_t i = 0; i < is_needed_view.size(); ++i) {
    const json* extension = find_meshopt(document.json["bufferViews"][i]);
    if (is_needed_view[i] && extension != nullptr) decoder.decode_view(i, *extension);
  }
}

}  // namespace promin
