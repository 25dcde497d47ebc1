// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/buffers.h"

#include <array>
#include <cstdint>

#include "core/file.h"
#include "formats/gltf/checks.h"
#include "formats/gltf/draco.h"
#include "formats/gltf/json_lookup.h"
#include "formats/gltf/meshopt.h"
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

std::optional<Bytes> read_data_uri(const std::string& uri, const std::string& place, LoadReport& report,
                                   uint64_t most_bytes = std::numeric_limits<uint64_t>::max()) {
  constexpr std::string_view kMarker = ";base64,";
  const size_t marker = uri.find(kMarker);
  if (marker == std::string::npos || uri.find(',') != marker + kMarker.size() - 1) {
    report.refuse("the data: URI is not base64", place, "write data:application/octet-stream;base64,...");
    return std::nullopt;
  }
  std::string_view text = std::string_view(uri).substr(marker + kMarker.size());
  // Four letters are three bytes.
  if (most_bytes / 3 < text.size() / 4) text = text.substr(0, (most_bytes / 3 + 1) * 4);
  std::optional<Bytes> bytes = decode_base64(text);
  if (!bytes) report.refuse("the data: URI holds broken base64", place, "export the file again");
  return bytes;
}

bool is_data(const std::string& uri) {
  return uri.starts_with("data:");
}

std::optional<std::filesystem::path> find_file(const std::string& uri, const std::string& place, bool must_exist,
                                               LoadReport& report) {
  const std::optional<std::string> name = decode_percent(uri);
  if (name) return find_beside_scene(*name, place, must_exist, report);
  report.refuse("the URI holds a broken percent escape", place, "write % as %25");
  return std::nullopt;
}

/// The number of bytes that a URI names; 0 where the file is missing. A URI that leads where it must not is refused.
uint64_t size_of_uri(const std::string& uri, const std::string& place, LoadReport& report) {
  if (is_data(uri)) return read_data_uri(uri, place, report).value_or(Bytes{}).size();
  const auto file = find_file(uri, place, false, report);
  if (!file) return 0;
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(*file, error);
  return error ? 0 : size;
}

std::string say_too_short(uint64_t size, uint64_t length) {
  return "has " + std::to_string(size) + " bytes, less than its byteLength of " + std::to_string(length);
}

std::vector<bool> find_needed_buffers(const GltfDocument& document, const std::vector<bool>& is_needed_view) {
  std::vector<bool> is_needed(elements_of(document.json, "buffers").size(), false);
  for (size_t i = 0; i < is_needed_view.size(); ++i) {
    if (!is_needed_view[i]) continue;
    const json* compressed = find_meshopt(document.json["bufferViews"][i]);
    const auto own = static_cast<size_t>(document.views[i].buffer);
    is_needed[compressed == nullptr ? own : (*compressed)["buffer"].get<size_t>()] = true;
  }
  return is_needed;
}

/// Whether the buffer only stands for what compressed views hold, and needs no bytes.
bool is_fallback(const json& buffer) {
  const json* extension = find_meshopt(buffer);
  if (extension == nullptr) return false;
  const auto fallback = extension->find("fallback");
  return fallback != extension->end() && *fallback == true;
}

/// Finds the views that readers of a document need.
class NeededViews {
 public:
  explicit NeededViews(const GltfDocument& document) : document_(document), is_needed_(document.views.size(), false) {
    for (size_t m = 0; m < document.meshes.size(); ++m) {
      const std::vector<GltfPrimitive>& primitives = document.meshes[m].primitives;
      for (size_t p = 0; p < primitives.size(); ++p) {
        need_primitive(primitives[p], document.json["meshes"][m]["primitives"][p]);
      }
    }
    for (const json& node : elements_of(document.json, "nodes")) {
      const json* instances = find_extension(node, "EXT_mesh_gpu_instancing");
      if (instances == nullptr) continue;
      for (const auto& [name, accessor] : (*instances)["attributes"].items()) need_accessor(accessor);
    }
    for (const GltfMesh& mesh : document.meshes) {
      if (has_morph(mesh.weights)) need_targets(mesh);
    }
    for (const GltfNode& node : document.nodes) {
      const bool is_morphed = node.mesh >= 0 && node.weights && has_morph(*node.weights);
      if (is_morphed) need_targets(document.meshes[static_cast<size_t>(node.mesh)]);
    }
    for (const json& image : elements_of(document.json, "images")) need_view(image.value("bufferView", -1));
  }

  std::vector<bool> take() { return std::move(is_needed_); }

 private:
  void need_view(int view) {
    if (view >= 0) is_needed_[static_cast<size_t>(view)] = true;
  }

  void need_accessor(int index) {
    if (index < 0) return;
    const GltfAccessor& accessor = document_.accessors[static_cast<size_t>(index)];
    need_view(accessor.view);
    if (!accessor.sparse) return;
    need_view(accessor.sparse->index_view);
    need_view(accessor.sparse->value_view);
  }

  void need_targets(const GltfMesh& mesh) {
    for (const GltfPrimitive& primitive : mesh.primitives) {
      for (const auto& target : primitive.targets) {
        for (const auto& [name, accessor] : target) need_accessor(accessor);
      }
    }
  }

  void need_primitive(const GltfPrimitive& primitive, const json& source) {
    const json* draco = find_draco(source);
    if (draco != nullptr) need_view((*draco)["bufferView"]);
    if (draco == nullptr) need_accessor(primitive.indices);
    for (const auto& [name, accessor] : primitive.attributes) {
      const bool is_compressed = draco != nullptr && (*draco)["attributes"].contains(name);
      if (is_read_attribute(name) && !is_compressed) need_accessor(accessor);
    }
  }

  const GltfDocument& document_;
  std::vector<bool> is_needed_;
};

}  // namespace

std::optional<Bytes> read_gltf_uri(const std::string& uri, const std::string& place, LoadReport& report,
                                   uint64_t most_bytes) {
  if (is_data(uri)) return read_data_uri(uri, place, report, most_bytes);
  const auto file = find_file(uri, place, true, report);
  if (!file) return std::nullopt;
  return read_file(*file, most_bytes);
}

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

std::vector<bool> find_needed_views(const GltfDocument& document) {
  return NeededViews(document).take();
}

GltfBuffers read_gltf_buffers(const GltfDocument& document, const std::vector<bool>& is_needed_view,
                              std::optional<std::span<const std::byte>> glb_binary, LoadReport& report) {
  const std::vector<bool> is_needed = find_needed_buffers(document, is_needed_view);
  GltfBuffers buffers;
  for (const json& source : elements_of(document.json, "buffers")) {
    const size_t index = buffers.bytes.size();
    std::span<const std::byte>& bytes = buffers.bytes.emplace_back();
    const std::string place = "buffers[" + std::to_string(index) + "]";
    const auto length = source["byteLength"].get<uint64_t>();
    const bool has_uri = source.contains("uri");
    // The binary chunk belongs to the first buffer alone.
    const bool is_chunk = !has_uri && index == 0 && glb_binary;
    if (!is_needed[index]) {
      if (is_fallback(source)) continue;
      const uint64_t size = has_uri    ? size_of_uri(source["uri"], place + ".uri", report)
                            : is_chunk ? glb_binary->size()
                                       : 0;
      if (size < length) report.warn(place + " " + say_too_short(size, length) + "; no mesh needs it");
      continue;
    }
    if (has_uri) {
      std::optional<Bytes> own = read_gltf_uri(source["uri"], place + ".uri", report);
      if (!own) continue;
      bytes = buffers.own.emplace_back(std::move(*own));
    } else if (is_chunk) {
      bytes = *glb_binary;
    } else {
      report.refuse("the buffer has no bytes", place, "add a uri, or a binary chunk to the GLB file");
      continue;
    }
    if (bytes.size() < length) {
      report.refuse("the buffer " + say_too_short(bytes.size(), length), place, "export the file again");
    }
  }
  return buffers;
}

}  // namespace promin
