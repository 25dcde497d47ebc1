// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/checks.h"
#include "formats/gltf/json_lookup.h"

namespace promin {

using nlohmann::json;

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

  const json& cameras = elements_of(document, "cameras");
  for (size_t i = 0; i < cameras.size(); ++i) {
    const std::string type = cameras[i]["type"];
    if (cameras[i].contains(type)) continue;
    report.refuse(quote(type) + " is missing", "cameras[" + std::to_string(i) + "]",
                  "add the camera's parameters under that name");
  }
}

}  // namespace promin
