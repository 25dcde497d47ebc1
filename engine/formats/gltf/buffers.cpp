// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/buffers.h"

#include <algorithm>
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
  // The letters of RFC 4648, section 5, are accepted too.
  values['-'] = values['+'];
  values['_'] = values['/'];
  return values;
}

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Returns whether a text has this ending; upper and lower case are equal.
bool has_ending(std::string_view text, std::string_view ending) {
  if (text.size() < ending.size()) return false;
  return std::ranges::equal(text.substr(text.size() - ending.size()), ending, [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

// The following functions return nullopt after they have added the reason to the report.

std::optional<Bytes> read_data_uri(const std::string& uri, const std::string& place, LoadReport& report,
                                   uint64_t most_bytes = std::numeric_limits<uint64_t>::max()) {
  const size_t comma = uri.find(',');
  if (comma == std::string::npos || !has_ending(std::string_view(uri).substr(0, comma), ";base64")) {
    report.refuse("gltf.uri.broken", "the data: URI is not base64", place,
                  "write data:application/octet-stream;base64,...");
    return std::nullopt;
  }
  std::string_view text = std::string_view(uri).substr(comma + 1);
  std::optional<std::string> unescaped;
  if (text.find_first_of("% \t\r\n") != std::string_view::npos) {
    unescaped = decode_percent(text);
    if (unescaped) std::erase_if(*unescaped, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
    text = unescaped ? std::string_view(*unescaped) : "*";
  }
  // Four letters encode three bytes.
  if (most_bytes / 3 < text.size() / 4) text = text.substr(0, (most_bytes / 3 + 1) * 4);
  std::optional<Bytes> bytes = decode_base64(text);
  if (!bytes) report.refuse("gltf.uri.broken", "the data: URI contains invalid base64", place, "export the file again");
  return bytes;
}

bool is_data(const std::string& uri) {
  constexpr std::string_view kScheme = "data:";
  return uri.size() >= kScheme.size() && has_ending(std::string_view(uri).substr(0, kScheme.size()), kScheme);
}

std::optional<std::filesystem::path> find_file(const std::string& uri, const std::string& place, bool must_exist,
                                               LoadReport& report) {
  const std::optional<std::string> name = decode_percent(uri);
  if (name) return find_beside_scene(*name, place, must_exist, report);
  report.refuse("gltf.uri.broken", "the URI contains an invalid percent escape", place, "write % as %25");
  return std::nullopt;
}

/// Returns the number of bytes to which a URI refers; 0 if they cannot be read.
uint64_t size_of_uri(const std::string& uri, const std::string& place, const LoadReport& report) {
  LoadReport attempt = report.make_attempt();
  if (is_data(uri)) return read_data_uri(uri, place, attempt).value_or(Bytes{}).size();
  const auto file = find_file(uri, place, false, attempt);
  if (!file) return 0;
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(*file, error);
  return error ? 0 : size;
}

std::string say_too_short(uint64_t size, uint64_t length) {
  return "has " + std::to_string(size) + " bytes, fewer than its byteLength of " + std::to_string(length);
}

/// The buffer that contains the bytes of a view, compressed or not, and the offset of their end.
struct Extent {
  size_t buffer = 0;
  uint64_t end = 0;
};

Extent extent_of(const GltfDocument& document, size_t index) {
  const GltfBufferView& view = document.views[index];
  const json* compressed = find_meshopt(document.json["bufferViews"][index]);
  if (compressed == nullptr) return {static_cast<size_t>(view.buffer), view.byte_offset + view.byte_length};
  return {(*compressed)["buffer"],
          compressed->value("byteOffset", uint64_t{0}) + (*compressed)["byteLength"].get<uint64_t>()};
}

/// Returns for each buffer the number of bytes that the needed views cover.
std::vector<uint64_t> find_needed_bytes(const GltfDocument& document, bool with_extras) {
  std::vector<uint64_t> needed(elements_of(document.json, "buffers").size(), 0);
  const std::vector<bool> is_needed_view = find_needed_views(document, with_extras);
  for (size_t i = 0; i < is_needed_view.size(); ++i) {
    if (!is_needed_view[i]) continue;
    const Extent extent = extent_of(document, i);
    needed[extent.buffer] = std::max(needed[extent.buffer], extent.end);
  }
  return needed;
}

/// Returns whether the buffer only stands for the decompressed content of views, and needs no bytes.
bool is_fallback(const json& buffer) {
  const json* extension = find_meshopt(buffer);
  if (extension == nullptr) return false;
  const auto fallback = extension->find("fallback");
  return fallback != extension->end() && *fallback == true;
}

/// Finds the views whose bytes the readers of a document need.
class NeededViews {
 public:
  NeededViews(const GltfDocument& document, bool with_extras)
      : document_(document), is_needed_(document.views.size(), false) {
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
    for (const json& skin : elements_of(document.json, "skins")) need_accessor(skin.value("inverseBindMatrices", -1));
    if (!with_extras) return;
    for (const GltfMesh& mesh : document.meshes) need_targets(mesh);
    for (const json& animation : elements_of(document.json, "animations")) need_animation(animation);
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

  void need_animation(const json& animation) {
    // An animation or sampler that cannot be used is null (JsonCheck).
    if (animation.is_null()) return;
    for (const json& sampler : elements_of(animation, "samplers")) {
      if (sampler.is_null()) continue;
      need_accessor(sampler.value("input", -1));
      need_accessor(sampler.value("output", -1));
    }
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

/// Some exporters count bytes of padding that they do not write.
constexpr uint64_t kMostPadding = 3;

/// Reads the buffers of one document.
class BufferReader {
 public:
  BufferReader(const GltfDocument& document, std::optional<std::span<const std::byte>> glb_binary, LoadReport& report)
      : document_(document),
        glb_binary_(glb_binary),
        report_(report),
        needed_(find_needed_bytes(document, true)),
        needed_by_meshes_(find_needed_bytes(document, false)) {}

  GltfBuffers read() {
    for (const json& source : elements_of(document_.json, "buffers")) {
      const size_t index = buffers_.bytes.size();
      buffers_.bytes.emplace_back();
      // A buffer that cannot be used is null (check_gltf_schema).
      if (source.is_null()) continue;
      if (source["byteLength"] == 0) {
        report_.repair({"gltf.buffer.empty", "a buffer has no bytes", "", place_of(index), "remove it",
                        "nothing is read from it"});
      } else if (needed_[index] == 0) {
        weigh_unneeded(source, index);
      } else if (needed_by_meshes_[index] > 0) {
        read_buffer(source, index, report_);
      } else {
        try_buffer(source, index);
      }
    }
    return std::move(buffers_);
  }

 private:
  static std::string place_of(size_t index) { return "buffers[" + std::to_string(index) + "]"; }

  /// Only the first buffer can be the binary chunk.
  bool is_chunk(const json& source, size_t index) const {
    return !source.contains("uri") && index == 0 && glb_binary_.has_value();
  }

  void weigh_unneeded(const json& source, size_t index) {
    if (is_fallback(source)) return;
    const auto length = source["byteLength"].get<uint64_t>();
    const uint64_t size = source.contains("uri")    ? size_of_uri(source["uri"], place_of(index) + ".uri", report_)
                          : is_chunk(source, index) ? glb_binary_->size()
                                                    : 0;
    if (size < length) report_.warn(place_of(index) + " " + say_too_short(size, length) + "; no mesh needs it");
  }

  void read_buffer(const json& source, size_t index, LoadReport& report) {
    std::span<const std::byte>& bytes = buffers_.bytes[index];
    if (source.contains("uri")) {
      std::optional<Bytes> own = read_gltf_uri(source["uri"], place_of(index) + ".uri", report);
      if (!own) return;
      bytes = buffers_.own.emplace_back(std::move(*own));
    } else if (is_chunk(source, index)) {
      bytes = *glb_binary_;
    } else {
      report.refuse("gltf.buffer.missing", "the buffer has no bytes", place_of(index),
                    "add a uri, or a binary chunk to the GLB file");
      return;
    }
    if (bytes.size() < source["byteLength"].get<uint64_t>()) repair_length(source["byteLength"], index);
  }

  /// Accepts a buffer that is shorter than declared if its views need none of the missing bytes. If the views need up
  /// to three of the missing bytes, these are padding and become 0.
  void repair_length(uint64_t length, size_t index) {
    std::span<const std::byte>& bytes = buffers_.bytes[index];
    const uint64_t needed = needed_by_meshes_[index];
    if (needed > bytes.size() + kMostPadding) {
      report_.refuse("gltf.buffer.short", "the buffer " + say_too_short(bytes.size(), length), place_of(index),
                     "export the file again");
      return;
    }
    report_.repair({"gltf.buffer.short", "a buffer is shorter than its byteLength",
                    std::to_string(bytes.size()) + " bytes instead of " + std::to_string(length), place_of(index),
                    "export the file again", "the existing part is read"});
    if (needed <= bytes.size()) return;
    Bytes& own = buffers_.own.emplace_back(bytes.begin(), bytes.end());
    own.resize(needed);
    bytes = own;
  }

  /// Reads a buffer that contains only images, animations or unused morph targets. If it cannot be read, these are left
  /// out.
  void try_buffer(const json& source, size_t index) {
    LoadReport attempt = report_.make_attempt();
    try {
      read_buffer(source, index, attempt);
      attempt.throw_if_refused();
    } catch (const InputError& error) {
      buffers_.bytes[index] = {};
      report_.repair({"gltf.buffer.unreadable",
                      "a buffer of images or animations cannot be read: " + error.problems().front().what, "",
                      place_of(index), "export the file again", "promin omits them"});
    }
    for (const SourceFile& file : attempt.sources()) report_.add_source(file.file);
  }

  const GltfDocument& document_;
  std::optional<std::span<const std::byte>> glb_binary_;
  LoadReport& report_;
  std::vector<uint64_t> needed_;
  std::vector<uint64_t> needed_by_meshes_;
  GltfBuffers buffers_;
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

std::vector<bool> find_needed_views(const GltfDocument& document, bool with_extras) {
  return NeededViews(document, with_extras).take();
}

bool has_bytes(const GltfDocument& document, size_t view) {
  const Extent extent = extent_of(document, view);
  return extent.end <= document.buffers.bytes[extent.buffer].size();
}

bool has_accessor_bytes(const GltfDocument& document, int accessor) {
  const GltfAccessor& source = document.accessors[static_cast<size_t>(accessor)];
  const auto has_view = [&](int view) { return view < 0 || has_bytes(document, static_cast<size_t>(view)); };
  return has_view(source.view) &&
         (!source.sparse || (has_view(source.sparse->index_view) && has_view(source.sparse->value_view)));
}

GltfBuffers read_gltf_buffers(const GltfDocument& document, std::optional<std::span<const std::byte>> glb_binary,
                              LoadReport& report) {
  return BufferReader(document, glb_binary, report).read();
}

}  // namespace promin
