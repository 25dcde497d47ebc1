// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/cameras.h"

#include <algorithm>

#include "promin/validate.h"

namespace promin {
namespace {

/// Columns shorter than this, or this near to parallel, have no direction left to normalise.
constexpr double kLeastSine = 1e-9;

void read_pose(const PlacedNode& placed, Camera& camera, LoadReport& report) {
  const std::string place = "nodes[" + std::to_string(placed.node) + "]";
  const dvec3 eye(placed.world_from_object[3]);
  if (!(std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z)}) <= kMaxCoordinate)) {
    report.refuse("the camera lies beyond 1e15 in the world", place, "use a smaller translation in it and its parents");
  }
  const dvec3 back(placed.world_from_object[2]);
  const dvec3 y(placed.world_from_object[1]);
  const dvec3 look = -back / glm::length(back);
  const dvec3 up = y / glm::length(y);
  const dvec3 upright = up - glm::dot(up, look) * look;
  const double sine = glm::length(upright);
  // Written so that the NaN of a column without length fails.
  if (!(sine > kLeastSine)) {
    report.refuse("the camera has no orientation", place, "use a scale other than 0 in it and its parents");
  }
  camera.eye = vec3(eye);
  camera.look = vec3(look);
  camera.up = vec3(upright / sine);
}

}  // namespace

std::optional<Camera> read_gltf_camera(const GltfDocument& document, const PlacedNode& placed, LoadReport& report) {
  const GltfNode& node = document.nodes[static_cast<size_t>(placed.node)];
  if (node.camera < 0) return std::nullopt;
  const nlohmann::json& source = document.json["cameras"][static_cast<size_t>(node.camera)];
  const std::string type = source["type"];
  const nlohmann::json& parameters = source[type];
  Camera camera;
  camera.name = node.name.empty() ? source.value("name", "") : node.name;
  // A camera without znear starts at the eye; zfar is never used.
  camera.near = static_cast<float>(parameters.value("znear", 0.0));
  if (type == "perspective") {
    camera.yfov = static_cast<float>(parameters["yfov"].get<double>());
    camera.aspect_ratio = static_cast<float>(parameters.value("aspectRatio", 0.0));
  } else {
    const double xmag = parameters["xmag"];
    const double ymag = parameters["ymag"];
    camera.projection = Projection::kOrthographic;
    camera.ymag = static_cast<float>(ymag);
    camera.aspect_ratio = static_cast<float>(xmag / ymag);
  }
  read_pose(placed, camera, report);
  return camera;
}

}  // namespace promin
