// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string_view>

#include "core/json_text.h"
#include "formats/gltf/checks.h"
#include "formats/gltf/draco.h"
#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

/// The largest number of elements of an accessor that contains only zeros. Such an accessor needs no bytes in the file,
/// so the file's size does not limit it.
constexpr uint64_t kMaxZeroElements = 1 << 24;

struct Format {
  std::string_view attribute;
  std::string_view type;
  int component_type;
  /// Whether the accessor must be normalized (true), must not be (false), or may be (nullopt).
  std::optional<bool> normalized;
};

/// The attributes of vertices and of instances that the loader reads; "indices" stands for a primitive's indices,
/// "inverseBindMatrices" for those of a skin.
constexpr Format kAccessorFormats[] = {
    {"POSITION", "VEC3", kGltfFloat, {}},
    {"POSITION", "VEC3", kGltfByte, {}},
    {"POSITION", "VEC3", kGltfUnsignedByte, {}},
    {"POSITION", "VEC3", kGltfShort, {}},
    {"POSITION", "VEC3", kGltfUnsignedShort, {}},
    {"NORMAL", "VEC3", kGltfFloat, {}},
    {"NORMAL", "VEC3", kGltfByte, true},
    {"NORMAL", "VEC3", kGltfShort, true},
    {"COLOR_0", "VEC3", kGltfFloat, {}},
    {"COLOR_0", "VEC3", kGltfUnsignedByte, true},
    {"COLOR_0", "VEC3", kGltfUnsignedShort, true},
    {"COLOR_0", "VEC4", kGltfFloat, {}},
    {"COLOR_0", "VEC4", kGltfUnsignedByte, true},
    {"COLOR_0", "VEC4", kGltfUnsignedShort, true},
    {"TEXCOORD_0", "VEC2", kGltfFloat, {}},
    {"TEXCOORD_0", "VEC2", kGltfByte, {}},
    {"TEXCOORD_0", "VEC2", kGltfUnsignedByte, {}},
    {"TEXCOORD_0", "VEC2", kGltfShort, {}},
    {"TEXCOORD_0", "VEC2", kGltfUnsignedShort, {}},
    {"TEXCOORD_1", "VEC2", kGltfFloat, {}},
    {"TEXCOORD_1", "VEC2", kGltfByte, {}},
    {"TEXCOORD_1", "VEC2", kGltfUnsignedByte, {}},
    {"TEXCOORD_1", "VEC2", kGltfShort, {}},
    {"TEXCOORD_1", "VEC2", kGltfUnsignedShort, {}},
    {"TANGENT", "VEC4", kGltfFloat, {}},
    {"TANGENT", "VEC4", kGltfByte, true},
    {"TANGENT", "VEC4", kGltfShort, true},
    {"JOINTS_0", "VEC4", kGltfUnsignedByte, false},
    {"JOINTS_0", "VEC4", kGltfUnsignedShort, false},
    {"WEIGHTS_0", "VEC4", kGltfFloat, {}},
    {"WEIGHTS_0", "VEC4", kGltfUnsignedByte, true},
    {"WEIGHTS_0", "VEC4", kGltfUnsignedShort, true},
    {"inverseBindMatrices", "MAT4", kGltfFloat, {}},
    {"indices", "SCALAR", kGltfUnsignedByte, {}},
    {"indices", "SCALAR", kGltfUnsignedShort, {}},
    {"indices", "SCALAR", kGltfUnsignedInt, {}},
    {"TRANSLATION", "VEC3", kGltfFloat, {}},
    {"ROTATION", "VEC4", kGltfFloat, {}},
    {"ROTATION", "VEC4", kGltfByte, true},
    {"ROTATION", "VEC4", kGltfShort, true},
    {"SCALE", "VEC3", kGltfFloat, {}},
};

std::string at(const char* array, size_t index) {
  return std::string(array) + "[" + std::to_string(index) + "]";
}

/// Returns the number of bytes of an element. Columns of matrices are padded to 4 bytes.
uint64_t element_bytes(const std::string& type, int component_type) {
  if (!type.starts_with("MAT")) return component_count(type) * component_bytes(component_type);
  const auto rows = static_cast<uint64_t>(type[3] - '0');
  return rows * ((rows * component_bytes(component_type) + 3) / 4 * 4);
}

/// Returns the number of bytes of an element without the padding of the last column, which a view need not contain.
uint64_t needed_bytes(const std::string& type, int component_type) {
  const uint64_t bytes = element_bytes(type, component_type);
  if (!type.starts_with("MAT")) return bytes;
  const uint64_t column = static_cast<uint64_t>(type[3] - '0') * component_bytes(component_type);
  return bytes - ((column + 3) / 4 * 4 - column);
}

/// Returns the first name of a series: all sets of joints and weights are read, and have the formats of the first set.
std::string_view first_of_sets(std::string_view attribute) {
  if (attribute.starts_with("JOINTS_")) return "JOINTS_0";
  return attribute.starts_with("WEIGHTS_") ? "WEIGHTS_0" : attribute;
}

/// Refuses `count` elements that do not fit into a buffer view. The computation does not overflow in 64 bits: the
/// schema keeps offsets below 2^53, counts and strides below 2^31.
void check_fit(const json& view, uint64_t offset, uint64_t count, uint64_t stride, uint64_t size,
               const std::string& place, LoadReport& report) {
  const auto available = view["byteLength"].get<uint64_t>();
  const uint64_t end = count == 0 ? 0 : offset + (count - 1) * stride + size;
  if (end <= available) return;
  report.refuse("gltf.accessor.short",
                "the elements end at byte " + std::to_string(end) + " of a buffer view of " +
                    std::to_string(available) + " bytes",
                place, "correct the count, the offset or the buffer view");
}

/// Returns the stride of a view. A stride of 0 stands for packed elements.
uint64_t stride_of(const json& view, uint64_t element) {
  const uint64_t stride = view.value("byteStride", element);
  return stride == 0 ? element : stride;
}

void check_accessor(const json& document, const json& accessor, bool is_plain, const std::string& place,
                    LoadReport& report) {
  const auto count = accessor["count"].get<uint64_t>();
  if (count == 0) {
    report.repair({"gltf.accessor.empty", "an accessor has no elements", "", place + ".count",
                   "remove the parts that use it", "nothing is drawn from it"});
  }
  const std::string type = accessor["type"];
  const int component_type = accessor["componentType"];
  const uint64_t size = element_bytes(type, component_type);
  if (accessor.contains("bufferView")) {
    const json& view = document["bufferViews"][accessor["bufferView"].get<size_t>()];
    const uint64_t stride = stride_of(view, size);
    if (stride < size) {
      report.refuse("gltf.accessor.stride",
                    "a stride of " + std::to_string(stride) + " bytes is less than the " + std::to_string(size) +
                        " bytes of an element",
                    place, "correct byteStride of its buffer view");
    }
    check_fit(view, accessor.value("byteOffset", uint64_t{0}), count, stride, needed_bytes(type, component_type), place,
              report);
  } else if (is_plain && count > kMaxZeroElements) {
    report.refuse("gltf.accessor.large", "an accessor of " + std::to_string(count) + " zeros is too large",
                  place + ".count", "add a buffer view or use at most " + std::to_string(kMaxZeroElements));
  }

  if (!accessor.contains("sparse")) return;
  const auto& sparse = accessor["sparse"];
  const auto sparse_count = sparse["count"].get<uint64_t>();
  const auto check_part = [&](const char* part, uint64_t part_size) {
    const json& view = document["bufferViews"][sparse[part]["bufferView"].get<size_t>()];
    check_fit(view, sparse[part].value("byteOffset", uint64_t{0}), sparse_count, part_size, part_size,
              place + ".sparse." + part, report);
  };
  check_part("indices", component_bytes(sparse["indices"]["componentType"]));
  check_part("values", size);
}

bool has_format(const json& accessor, std::string_view attribute) {
  attribute = first_of_sets(attribute);
  const auto& type = accessor["type"].get_ref<const std::string&>();
  const int component_type = accessor["componentType"];
  const bool normalized = accessor.value("normalized", false);
  return std::ranges::any_of(kAccessorFormats, [&](const Format& format) {
    return format.component_type == component_type && format.attribute == attribute && format.type == type &&
           format.normalized.value_or(normalized) == normalized;
  });
}

std::string say_format(const json& accessor) {
  return accessor["type"].get<std::string>() + " of " + json_text(accessor["componentType"]) +
         (accessor.value("normalized", false) ? ", normalized" : "");
}

void check_format(const json& accessor, std::string_view attribute, const std::string& place, LoadReport& report) {
  if (has_format(accessor, attribute) || !is_read_attribute(attribute)) return;
  report.refuse("gltf.accessor.format", "the accessor's format (" + say_format(accessor) + ") is not allowed here",
                place, "export it as the glTF specification requires");
}

/// Checks that the attributes of instances agree with each other.
void check_attributes(const json& attributes, const json& accessors, const std::string& place, LoadReport& report) {
  uint64_t first_count = 0;
  for (const auto& [name, index] : attributes.items()) {
    const json& accessor = accessors[index.get<size_t>()];
    check_format(accessor, name, place + "." + name, report);
    const auto count = accessor["count"].get<uint64_t>();
    if (first_count == 0) first_count = count;
    if (count != first_count) {
      report.refuse("gltf.accessor.count",
                    "the attribute has " + std::to_string(count) + " elements, but other attributes have " +
                        std::to_string(first_count),
                    place + "." + name, "give all attributes the same number of elements");
    }
  }
}

/// Returns whether an attribute that only affects shading does not match the other attributes. If so, adds the reason
/// to the report.
bool is_left_out(std::string_view name, const json& accessor, uint64_t vertex_count, const std::string& place,
                 LoadReport& report) {
  const auto count = accessor["count"].get<uint64_t>();
  const bool has_wrong_format = is_read_attribute(name) && !has_format(accessor, name);
  if (has_wrong_format) {
    report.repair({"gltf.accessor.format", "the format of an attribute is not allowed", say_format(accessor), place,
                   "export it as the glTF specification requires", "promin omits the attribute"});
  } else if (count != vertex_count) {
    report.repair({"gltf.accessor.count", "an attribute does not have one element for each vertex",
                   std::to_string(count) + " for " + std::to_string(vertex_count) + " vertices", place,
                   "give all attributes the same number of elements", "promin omits the attribute"});
  }
  return has_wrong_format || count != vertex_count;
}

/// Checks that the attributes of vertices agree with each other. Invalid attributes other than the position are
/// removed. A mesh without valid joints is not posed.
void check_vertices(json& attributes, const json& accessors, const std::string& place, LoadReport& report) {
  const auto positions = attributes.find("POSITION");
  if (positions == attributes.end()) return;
  const auto vertex_count = accessors[positions->get<size_t>()]["count"].get<uint64_t>();
  for (auto attribute = attributes.begin(); attribute != attributes.end();) {
    const std::string& name = attribute.key();
    const std::string at = place + "." + name;
    const json& accessor = accessors[attribute->get<size_t>()];
    if (name != "POSITION" && is_left_out(name, accessor, vertex_count, at, report)) {
      attribute = attributes.erase(attribute);
      continue;
    }
    check_format(accessor, name, at, report);
    ++attribute;
  }
}

/// Instances must have bytes in the file, so that the file's size limits their number.
void check_instances(const json& node, const json& accessors, const std::string& place, LoadReport& report) {
  const json* extension = find_extension(node, "EXT_mesh_gpu_instancing");
  if (extension == nullptr) return;
  const std::string attributes_place = place + ".extensions.EXT_mesh_gpu_instancing.attributes";
  const json& attributes = (*extension)["attributes"];
  check_attributes(attributes, accessors, attributes_place, report);
  for (const auto& [name, index] : attributes.items()) {
    if (accessors[index.get<size_t>()].contains("bufferView")) continue;
    report.refuse("gltf.instances.missing", "the instances have no buffer view, so all their values are 0",
                  attributes_place + "." + name, "add the values");
  }
}

void check_primitive(json& primitive, const json& accessors, const std::string& place, LoadReport& report) {
  check_vertices(primitive["attributes"], accessors, place + ".attributes", report);
  if (!primitive.contains("indices")) return;
  const json& indices = accessors[primitive["indices"].get<size_t>()];
  check_format(indices, "indices", place + ".indices", report);
  if (indices.value("normalized", false)) {
    report.repair({"gltf.accessor.format", "the indices are normalized", "", place + ".indices", "write integers",
                   "they are read as integers"});
  }
}

/// Marks the buffer views that accessors or compressed meshes use. Views that only images use are not marked.
std::vector<bool> find_structural_views(const json& document) {
  std::vector<bool> is_structural(elements_of(document, "bufferViews").size(), false);
  const auto mark = [&](const json& holder) {
    if (const auto view = holder.find("bufferView"); view != holder.end()) is_structural[view->get<size_t>()] = true;
  };
  for (const json& accessor : elements_of(document, "accessors")) {
    mark(accessor);
    if (!accessor.contains("sparse")) continue;
    mark(accessor["sparse"]["indices"]);
    mark(accessor["sparse"]["values"]);
  }
  for (const json& mesh : elements_of(document, "meshes")) {
    for (const json& primitive : mesh["primitives"]) {
      if (const json* draco = find_draco(primitive)) mark(*draco);
    }
  }
  return is_structural;
}

void check_view(const json& view, uint64_t available, const std::string& place, LoadReport& report) {
  const uint64_t end = view.value("byteOffset", uint64_t{0}) + view["byteLength"].get<uint64_t>();
  if (end > available) {
    report.refuse("gltf.view.short",
                  "the buffer view ends at byte " + std::to_string(end) + " of a buffer of " +
                      std::to_string(available) + " bytes",
                  place, "correct its byteOffset or byteLength");
  }
  if (view["byteLength"] == 0) {
    report.repair({"gltf.view.empty", "a buffer view has no bytes", "", place, "remove the parts that use it",
                   "nothing is read of it"});
  }
  if (const auto stride = view.find("byteStride"); stride != view.end()) {
    if (*stride >= 4 && *stride <= 252 && stride->get<uint64_t>() % 4 == 0) return;
    report.repair({"gltf.view.stride", "a stride is not a multiple of 4 from 4 to 252", stride->dump(),
                   place + ".byteStride", "add padding to the elements",
                   *stride == 0 ? "promin reads the elements without a stride" : "promin uses it as it is"});
  }
}

/// Removes views from images if they do not lie within their buffer.
void check_images(json& document, LoadReport& report) {
  if (!document.contains("images")) return;
  size_t i = 0;
  for (json& image : document["images"]) {
    const std::string place = at("images", i++);
    if (!image.contains("bufferView")) continue;
    const json& view = document["bufferViews"][image["bufferView"].get<size_t>()];
    const auto available = document["buffers"][view["buffer"].get<size_t>()]["byteLength"].get<uint64_t>();
    const uint64_t end = view.value("byteOffset", uint64_t{0}) + view["byteLength"].get<uint64_t>();
    if (end <= available) continue;
    report.repair({"gltf.view.short", "the buffer view of an image extends beyond its buffer",
                   std::to_string(end - available) + " bytes", place, "export the file again",
                   "promin omits the image"});
    image.erase("bufferView");
  }
}

/// Returns which accessors contain elements that mesh primitives read directly. The elements of the other accessors are
/// in a Draco stream.
std::vector<bool> find_plain_accessors(const json& document) {
  std::vector<bool> is_plain(elements_of(document, "accessors").size(), true);
  const auto visit = [&](bool is_compressed) {
    for (const json& mesh : elements_of(document, "meshes")) {
      for (const json& primitive : mesh["primitives"]) {
        const json* draco = find_draco(primitive);
        if (primitive.contains("indices") && (draco != nullptr) == is_compressed) {
          is_plain[primitive["indices"].get<size_t>()] = !is_compressed;
        }
        for (const json& target : elements_of(primitive, "targets")) {
          for (const auto& [name, index] : target.items()) is_plain[index.get<size_t>()] = true;
        }
        for (const auto& [name, index] : primitive["attributes"].items()) {
          const bool is_in_stream = draco != nullptr && (*draco)["attributes"].contains(name);
          if (is_in_stream == is_compressed) is_plain[index.get<size_t>()] = !is_compressed;
        }
      }
    }
  };
  visit(true);
  visit(false);
  return is_plain;
}

}  // namespace

bool is_read_attribute(std::string_view name) {
  name = first_of_sets(name);
  return std::any_of(std::begin(kAccessorFormats), std::end(kAccessorFormats),
                     [&](auto& format) { return format.attribute == name; });
}

uint64_t component_bytes(int component_type) {
  if (component_type == kGltfByte || component_type == kGltfUnsignedByte) return 1;
  return component_type == kGltfShort || component_type == kGltfUnsignedShort ? 2 : 4;
}

uint64_t component_count(const std::string& type) {
  if (type == "SCALAR") return 1;
  const auto n = static_cast<uint64_t>(type.back() - '0');
  return type.starts_with("MAT") ? n * n : n;
}

void check_gltf_accessors(json& document, bool is_strict, LoadReport& report) {
  const json& buffers = elements_of(document, "buffers");
  const json& views = elements_of(document, "bufferViews");
  check_images(document, report);
  const std::vector<bool> is_structural = find_structural_views(document);
  for (size_t i = 0; i < views.size(); ++i) {
    if (views[i].is_null() || !(is_structural[i] || is_strict)) continue;
    check_view(views[i], buffers[views[i]["buffer"].get<size_t>()]["byteLength"], at("bufferViews", i), report);
  }

  const json& accessors = elements_of(document, "accessors");
  const std::vector<bool> is_plain = find_plain_accessors(document);
  for (size_t i = 0; i < accessors.size(); ++i) {
    if (!accessors[i].is_null()) check_accessor(document, accessors[i], is_plain[i], at("accessors", i), report);
  }

  const json& nodes = elements_of(document, "nodes");
  for (size_t i = 0; i < nodes.size(); ++i) check_instances(nodes[i], accessors, at("nodes", i), report);
  const json& skins = elements_of(document, "skins");
  for (size_t i = 0; i < skins.size(); ++i) {
    const auto matrices = skins[i].find("inverseBindMatrices");
    if (matrices == skins[i].end()) continue;
    check_format(accessors[matrices->get<size_t>()], "inverseBindMatrices", at("skins", i) + ".inverseBindMatrices",
                 report);
  }

  if (!document.contains("meshes")) return;
  json& meshes = document["meshes"];
  for (size_t m = 0; m < meshes.size(); ++m) {
    auto& primitives = meshes[m]["primitives"];
    for (size_t p = 0; p < primitives.size(); ++p) {
      check_primitive(primitives[p], accessors, at("meshes", m) + "." + at("primitives", p), report);
    }
  }
}

}  // namespace promin
