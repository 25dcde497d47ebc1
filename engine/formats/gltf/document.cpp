// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/document.h"

#include "core/file.h"
#include "formats/gltf/buffers.h"
#include "formats/gltf/checks.h"
#include "formats/gltf/container.h"
#include "formats/gltf/parse_json.h"
#include "formats/gltf/schema.h"

namespace promin {
namespace {

using nlohmann::json;

/// Removes members that the loader reads elsewhere or not at all.
void erase_members(json& value, std::initializer_list<const char*> names) {
  if (value.is_object()) {
    for (const char* name : names) value.erase(name);
  }
  if (value.is_structured()) {
    for (json& element : value) erase_members(element, names);
  }
}

/// tinygltf gets what it is good at, the checked core of the document; never bytes, files, images or extensions,
/// where its own checks are thin.
tinygltf::Model make_model(const json& document, LoadReport& report) {
  json core = json::object();
  for (const char* part :
       {"asset", "scene", "scenes", "nodes", "meshes", "accessors", "bufferViews", "materials", "cameras"}) {
    if (document.contains(part)) core[part] = document[part];
  }
  core.emplace("cameras", json::array());
  erase_members(core, {"extensions", "extras", "min", "max", "targets", "weights", "skin"});
  // tinygltf insists on both; here a camera without znear starts at the eye, and zfar is never used.
  for (json& camera : core["cameras"]) {
    json& parameters = camera[camera["type"].get<std::string>()];
    for (const char* plane : {"znear", "zfar"}) {
      if (!parameters.contains(plane)) parameters[plane] = 0.0;
    }
  }

  const std::string text = core.dump();
  tinygltf::Model model;
  tinygltf::TinyGLTF parser;
  std::string errors;
  std::string warnings;
  if (!parser.LoadASCIIFromString(&model, &errors, &warnings, text.c_str(), static_cast<unsigned int>(text.size()),
                                  "")) {
    report.refuse("tinygltf cannot read the document: " + errors, "", "export the file again");
    report.throw_if_refused();
  }
  return model;
}

}  // namespace

GltfDocument read_gltf_document(LoadReport& report) {
  const std::vector<std::byte> bytes = read_file(report.file());
  const GltfContainer container = split_gltf(bytes, report);
  GltfDocument document;
  document.json = parse_json(container.json, report, "export the file again");

  check_gltf_schema(document.json, report);
  report.throw_if_refused();

  check_gltf_asset(document.json, report);
  check_gltf_nodes(document.json, report);
  check_gltf_accessors(document.json, report);
  document.buffers = read_gltf_buffers(document.json, container.binary, report);
  report.throw_if_refused();

  document.model = make_model(document.json, report);
  return document;
}

}  // namespace promin
