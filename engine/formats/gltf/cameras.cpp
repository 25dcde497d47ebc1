// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/cameras.h"

#include "motion/attach.h"

namespace promin {
namespace {

/// Sets the position and orientation of the camera. Returns false if the camera has none in the world.
bool read_pose(const PlacedNode& placed, Camera& camera, LoadReport& report) {
  const std::string place = "nodes[" + std::to_string(placed.node) + "]";
  const Attached attached = attach(placed.world_from_object, placed.rotation, camera);
  if (attached == Attached::kFar) {
    report.warn({"gltf.camera.far", "a camera lies beyond 1e15 in the world", "", place, "", "promin omits it"});
  } else if (attached == Attached::kWithoutDirection) {
    report.warn({"gltf.camera.direction", "a camera has no orientation", "", place, "", "promin omits it"});
  }
  return attached == Attached::kDone;
}

}  // namespace

std::optional<CameraLink> read_gltf_camera(const GltfDocument& document, const PlacedNode& placed, LoadReport& report) {
  const GltfNode& node = document.nodes[static_cast<size_t>(placed.node)];
  if (node.camera < 0) return std::nullopt;
  const nlohmann::json& source = document.json["cameras"][static_cast<size_t>(node.camera)];
  // A camera that cannot be used is null (JsonCheck).
  if (source.is_null()) return std::nullopt;
  const std::string type = source["type"];
  const nlohmann::json& parameters = source[type];
  CameraLink result{.node = placed.index, .definition = static_cast<uint32_t>(node.camera)};
  Camera& camera = result.rest;
  camera.name = node.name.empty() ? source.value("name", "") : node.name;
  // The visible range of a camera without znear starts at the eye. zfar is never used.
  camera.near = static_cast<float>(parameters.value("znear", 0.0));
  if (type == "perspective") {
    camera.yfov = static_cast<float>(parameters["yfov"].get<double>());
    camera.aspect_ratio = static_cast<float>(parameters.value("aspectRatio", 0.0));
  } else {
    const double xmag = parameters["xmag"];
    const double ymag = parameters["ymag"];
    camera.projection = Projection::kOrthographic;
    result.xmag = xmag;
    camera.ymag = static_cast<float>(ymag);
    camera.aspect_ratio = static_cast<float>(xmag / ymag);
  }
  if (!read_pose(placed, camera, report)) return std::nullopt;
  return result;
}

}  // namespace promin
