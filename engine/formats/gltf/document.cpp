// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/document.h"

#include <algorithm>

#include "core/file.h"
#include "formats/gltf/buffers.h"
#include "formats/gltf/checks.h"
#include "formats/gltf/container.h"
#include "formats/gltf/draco.h"
#include "formats/gltf/extensions.h"
#include "formats/gltf/json_lookup.h"
#include "formats/gltf/meshopt.h"
#include "formats/gltf/parse_json.h"
#include "formats/gltf/schema.h"

namespace promin {
namespace {

using nlohmann::json;

int index_of(const json& object, const char* name) {
  return object.value(name, -1);
}

// An element that nothing uses is null (check_gltf_schema), and its typed view is empty.

GltfBufferView view_of(const json& source) {
  if (source.is_null()) return {};
  return {index_of(source, "buffer"), source.value("byteOffset", size_t{0}), source["byteLength"],
          source.value("byteStride", size_t{0})};
}

GltfSparse sparse_of(const json& source) {
  const json& indices = source["indices"];
  const json& values = source["values"];
  GltfSparse sparse;
  sparse.count = source["count"];
  sparse.index_view = index_of(indices, "bufferView");
  sparse.index_offset = indices.value("byteOffset", size_t{0});
  sparse.index_type = indices["componentType"];
  sparse.value_view = index_of(values, "bufferView");
  sparse.value_offset = values.value("byteOffset", size_t{0});
  return sparse;
}

GltfAccessor accessor_of(const json& source) {
  GltfAccessor accessor;
  if (source.is_null()) return accessor;
  accessor.view = index_of(source, "bufferView");
  accessor.byte_offset = source.value("byteOffset", size_t{0});
  accessor.component_type = source["componentType"];
  accessor.component_count = component_count(source["type"]);
  accessor.count = source["count"];
  accessor.is_normalized = source.value("normalized", false);
  if (source.contains("sparse")) accessor.sparse = sparse_of(source["sparse"]);
  return accessor;
}

GltfPrimitive primitive_of(const json& source) {
  return {source["attributes"], index_of(source, "indices"), index_of(source, "material"),
          source.value("mode", kGltfTriangles), elements_of(source, "targets")};
}

GltfMesh mesh_of(const json& source) {
  GltfMesh mesh{source.value("name", ""), {}, elements_of(source, "weights")};
  for (const json& primitive : source["primitives"]) mesh.primitives.push_back(primitive_of(primitive));
  return mesh;
}

GltfNode node_of(const json& source) {
  GltfNode node{source.value("name", ""), index_of(source, "mesh"),        index_of(source, "camera"),
                index_of(source, "skin"), elements_of(source, "children"), std::nullopt};
  if (source.contains("weights")) node.weights = source["weights"].get<std::vector<double>>();
  return node;
}

/// Fills the typed views from a document that follows the schema.
void fill_views(GltfDocument& document) {
  const json& source = document.json;
  for (const json& view : elements_of(source, "bufferViews")) document.views.push_back(view_of(view));
  for (const json& accessor : elements_of(source, "accessors")) document.accessors.push_back(accessor_of(accessor));
  for (const json& mesh : elements_of(source, "meshes")) document.meshes.push_back(mesh_of(mesh));
  for (const json& node : elements_of(source, "nodes")) document.nodes.push_back(node_of(node));
  document.scene = source.value("scene", size_t{0});
}

/// Renames the draft of an extension to its final name; both have the same form.
void rename_extension(json& element, const char* draft, const char* name) {
  const auto extensions = element.find("extensions");
  if (extensions == element.end() || !extensions->is_object() || extensions->contains(name)) return;
  const auto found = extensions->find(draft);
  if (found == extensions->end()) return;
  (*extensions)[name] = std::move(*found);
  extensions->erase(draft);
}

/// Renames KHR_lights, which was the name of KHR_lights_punctual before its ratification.
void rename_lights(json& document) {
  rename_extension(document, "KHR_lights", "KHR_lights_punctual");
  const auto nodes = document.find("nodes");
  if (nodes == document.end() || !nodes->is_array()) return;
  for (json& node : *nodes) rename_extension(node, "KHR_lights", "KHR_lights_punctual");
}

void leave_out_images_without_bytes(GltfDocument& document) {
  if (!document.json.contains("images")) return;
  for (json& image : document.json["images"]) {
    if (image.contains("bufferView") && !has_bytes(document, image["bufferView"])) image.erase("bufferView");
  }
}

}  // namespace

bool has_morph(const std::vector<double>& weights) {
  return std::ranges::any_of(weights, [](double weight) { return weight != 0.0; });
}

std::span<const std::byte> bytes_of_view(const GltfDocument& document, int view) {
  const GltfBufferView& v = document.views[static_cast<size_t>(view)];
  return document.buffers.bytes[static_cast<size_t>(v.buffer)].subspan(v.byte_offset, v.byte_length);
}

GltfDocument read_gltf_document(const LoadOptions& options, LoadReport& report) {
  std::vector<std::byte> bytes = read_file(report.file());
  const GltfContainer container = split_gltf(bytes, report);
  GltfDocument document;
  document.json = parse_json(container.json, report, "export the file again");

  check_gltf_version(document.json, report);
  report.throw_if_refused();
  rename_lights(document.json);
  check_gltf_schema(document.json, options.is_strict, report);
  report.throw_if_refused();

  check_gltf_cameras(document.json, report);
  document.extensions = check_gltf_extensions(document.json, options.is_strict, report);
  check_gltf_nodes(document.json, options.is_strict, report);
  check_gltf_accessors(document.json, options.is_strict, report);
  check_gltf_meshopt(document.json, report);
  fill_views(document);
  document.buffers = read_gltf_buffers(document, container.binary, report);
  report.throw_if_refused();

  leave_out_images_without_bytes(document);
  const std::vector<bool> is_needed_view = find_needed_views(document, true);
  decode_gltf_meshopt(document, is_needed_view, report);
  report.throw_if_refused();
  decode_gltf_draco(document, report);
  report.throw_if_refused();

  // Moving the vector does not move its bytes, so the views of them stay valid.
  if (container.binary) document.glb = std::move(bytes);
  return document;
}

}  // namespace promin
