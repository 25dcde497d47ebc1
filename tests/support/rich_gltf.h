// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/gltf_builder.h"

namespace promin {

/// Returns a document with everything that the tables of broken documents change.
inline GltfBuilder rich_gltf() {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}};
  gltf.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}}}}};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", nlohmann::json::object()}}};
  gltf.json["extensions"]["KHR_implicit_shapes"]["shapes"] = {
      {{"type", "sphere"}, {"sphere", {{"radius", 1}}}},
      {{"type", "cylinder"}, {"cylinder", {{"height", 1}, {"radiusTop", 1}, {"radiusBottom", 1}}}}};
  for (const int shape : {0, 1}) {
    gltf.show({{"attributes", nlohmann::json::object()},
               {"extensions", {{"PROMIN_mesh_primitive_implicit_shape", {{"shape", shape}}}}}});
  }
  gltf.add_node({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  return gltf;
}

inline nlohmann::json& shape(GltfBuilder& gltf, size_t index) {
  return gltf.json["extensions"]["KHR_implicit_shapes"]["shapes"][index];
}
inline nlohmann::json& material_extension(GltfBuilder& gltf, const char* name) {
  return gltf.json["materials"][0]["extensions"][name];
}
inline nlohmann::json& light(GltfBuilder& gltf) {
  return gltf.json["extensions"]["KHR_lights_punctual"]["lights"][0];
}
inline nlohmann::json& primitive(GltfBuilder& gltf) {
  return gltf.json["meshes"][0]["primitives"][0];
}

}  // namespace promin
