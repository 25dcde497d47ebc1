// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/checks.h"
#include "formats/gltf/json_lookup.h"

namespace promin {

using nlohmann::json;

void check_gltf_cameras(json& document, LoadReport& report) {
  const auto cameras = document.find("cameras");
  if (cameras == document.end()) return;
  for (size_t i = 0; i < cameras->size(); ++i) {
    json& camera = (*cameras)[i];
    if (camera.is_null() || camera.contains(camera["type"].get<std::string>())) continue;
    report.repair({"json.missing", "the camera's parameters are missing", "", "cameras[" + std::to_string(i) + "]",
                   "add a member with the name of the camera's type", "promin omits the camera"});
    camera = nullptr;
  }
}

}  // namespace promin
