// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/cameras.h"

#include <algorithm>

#include "promin/validate.h"

namespace promin {
namespace {

/// The smallest length of a column, and the smallest sine of the angle between two columns, for which a direction can
/// be normalised.
constexpr double kLeastSine = 1e-9;

/// Sets the camera's axes from columns of any length. Returns whether the columns determine axes.
bool take_axes(const dmat3& columns, Camera& camera) {
  const dvec3 look = -columns[2] / glm::length(columns[2]);
  const dvec3 up = columns[1] / glm::length(columns[1]);
  const dvec3 upright = up - glm::dot(up, look) * look;
  const double sine = glm::length(upright);
  // The condition is written so that a NaN, from a column without length, fails.
  if (!(sine > kLeastSine)) return false;
  camera.look = vec3(look);
  camera.up = vec3(upright / sine);
  return true;
}

/// Sets the position and orientation of the camera. Returns false if the camera has none in the world.
bool read_pose(const PlacedNode& placed, Camera& camera, LoadReport& report) {
  const std::string place = "nodes[" + std::to_string(placed.node) + "]";
  const dvec3 eye(placed.world_from_object[3]);
  camera.eye = vec3(eye);
  if (!(std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z)}) <= kMaxCoordinate)) {
    report.warn({"gltf.camera.far", "a camera lies beyond 1e15 in the world", "", place, "", "promin omits it"});
    return false;
  }
  if (take_axes(dmat3(placed.world_from_object), camera)) return true;
  if (placed.rotation && take_axes(*placed.rotation, camera)) return true;
  report.warn({"gltf.camera.direction", "a camera has no orientation", "", place, "", "promin omits it"});
  return false;
}

}  // namespace

std::optional<Camera> read_gltf_camera(const GltfDocument& document, const PlacedNode& placed, LoadReport& report) {
  const GltfNode& node = document.nodes[static_cast<size_t>(placed.node)];
  if (node.camera < 0) return std::nullopt;
  const nlohmann::json& source = document.json["cameras"][static_cast<size_t>(node.camera)];
  // A camera that cannot be used is null (JsonCheck).
  if (source.is_null()) return std::nullopt;
  const std::string type = source["type"];
  const nlohmann::json& parameters = source[type];
  Camera camera;
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
    camera.ymag = static_cast<float>(ymag);
    camera.aspect_ratio = static_cast<float>(xmag / ymag);
  }
  if (!read_pose(placed, camera, report)) return std::nullopt;
  return camera;
}

}  // namespace promin
