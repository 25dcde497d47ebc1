// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include "formats/gltf/checks.h"
#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 14> kKnownExtensions = {"KHR_implicit_shapes",
                                                               "KHR_lights_punctual",
                                                               "KHR_materials_clearcoat",
                                                               "KHR_materials_emissive_strength",
                                                               "KHR_materials_ior",
                                                               "KHR_materials_specular",
                                                               "KHR_materials_unlit",
                                                               "KHR_mesh_quantization",
                                                               "KHR_node_visibility",
                                                               "KHR_texture_transform",
                                                               "OMI_environment_sky",
                                                               "PROMIN_lights_phong",
                                                               "PROMIN_materials_phong",
                                                               "PROMIN_mesh_primitive_implicit_shape"};

bool is_known(const std::string& extension) {
  return std::find(kKnownExtensions.begin(), kKnownExtensions.end(), extension) != kKnownExtensions.end();
}

/// Extensions of materials and their textures: the material that carries one is named where it is read.
bool is_of_materials(const std::string& extension) {
  return extension.starts_with("KHR_materials_") || extension.starts_with("KHR_texture_");
}

}  // namespace

void check_gltf_asset(const json& document, LoadReport& report) {
  const auto& asset = document["asset"];
  const std::string version = asset["version"];
  if (!version.starts_with("2.")) {
    report.refuse("glTF version " + quote(version) + " is not 2.x", "asset.version", "convert the file to glTF 2.0");
  }
  const std::string least_version = asset.value("minVersion", "2.0");
  if (least_version != "2.0") {
    report.refuse("the file needs glTF " + quote(least_version), "asset.minVersion", "export it for glTF 2.0");
  }

  const json& required = elements_of(document, "extensionsRequired");
  for (size_t i = 0; i < required.size(); ++i) {
    const std::string extension = required[i];
    if (is_known(extension)) continue;
    report.refuse("the required extension " + extension + " is not implemented",
                  "extensionsRequired[" + std::to_string(i) + "]", "export the scene without it");
  }
  for (const json& extension : elements_of(document, "extensionsUsed")) {
    if (is_known(extension) || is_of_materials(extension)) continue;
    report.warn("the extension " + extension.get<std::string>() + " is ignored");
  }

  const json& cameras = elements_of(document, "cameras");
  for (size_t i = 0; i < cameras.size(); ++i) {
    const std::string type = cameras[i]["type"];
    if (cameras[i].contains(type)) continue;
    report.refuse(quote(type) + " is missing", "cameras[" + std::to_string(i) + "]",
                  "add the camera's parameters under that name");
  }
}

}  // namespace promin
