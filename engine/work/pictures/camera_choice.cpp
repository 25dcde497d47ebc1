// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/camera_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parse_number.h"
#include "promin/error.h"
#include "promin/scene.h"
#include "scene/framing.h"
#include "work/pictures/camera.h"

namespace promin::work {
namespace {

/// The field of view, in degrees, of a camera at the user's eye.
constexpr double kEyeFovDeg = 40.0;

std::string list_cameras(const Scene& scene) {
  std::string text;
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", i);
    if (!scene.cameras[i].name.empty()) text += fmt::format(" ({})", scene.cameras[i].name);
  }
  return text;
}

/// Finds a camera by name or number. The name is tried first, because a camera may be called "2".
const Camera& find_camera(const Scene& scene, const std::string& selection) {
  if (scene.cameras.empty()) {
    throw UsageError({"camera.missing", "the scene has no cameras", scene.file.string(), "remove --camera"});
  }
  for (const Camera& camera : scene.cameras) {
    if (camera.name == selection) return camera;
  }
  const std::optional<size_t> index = to_number<size_t>(selection);
  if (!index || *index >= scene.cameras.size()) {
    throw UsageError({"camera.unknown", "the scene has no camera \"" + selection + "\"", scene.file.string(),
                      "choose one of: " + list_cameras(scene)});
  }
  return scene.cameras[*index];
}

/// Returns the default up direction: +Y. If +Y is the direction of view, it is the direction that puts the front of the
/// scene at the lower edge of a view from above.
dvec3 default_up(const dvec3& direction) {
  constexpr double kLeastAcross = 1e-6;
  const double across = std::hypot(direction.x, direction.z);
  if (across > kLeastAcross * std::abs(direction.y)) return dvec3(0.0, 1.0, 0.0);
  return dvec3(0.0, 0.0, direction.y < 0.0 ? -1.0 : 1.0);
}

/// Turns a camera to a direction; if `direction` is empty, the camera keeps its own direction.
void face(Camera& camera, const std::optional<dvec3>& direction, const std::optional<dvec3>& up) {
  if (!direction && !up) return;
  const dvec3 look = direction.value_or(dvec3(camera.look));
  const dvec3 top = up ? *up : direction ? default_up(look) : dvec3(camera.up);
  const Camera posed = FreeCamera::from_pose(camera.eye, vec3(look), vec3(top)).camera();
  camera.look = posed.look;
  camera.up = posed.up;
}

/// Returns the direction from an eye in the scene to a point of the world. If the user gave the eye, `eye` is its
/// position in the world.
dvec3 direction_to(const dvec3& point, const std::optional<dvec3>& eye, const Camera& camera, const dvec3& center) {
  const dvec3 direction = eye ? point - *eye : point - center - dvec3(camera.eye);
  if (direction != dvec3(0.0)) return direction;
  throw UsageError(
      {"camera.point.eye", "--look-at is the position of the eye", "", "give another point, or --direction"});
}

/// Returns the direction that the user gave; empty if the user gave none.
std::optional<dvec3> find_direction(const PoseOptions& pose, const Camera& camera, const dvec3& center) {
  if (pose.look_at) return direction_to(*pose.look_at, pose.eye, camera, center);
  return pose.direction;
}

float to_yfov(double degrees) {
  return static_cast<float>(glm::radians(degrees));
}

Camera zoom(Camera camera, double factor) {
  if (factor == 1.0) return camera;
  camera.yfov = static_cast<float>(2.0 * std::atan(std::tan(0.5 * static_cast<double>(camera.yfov)) / factor));
  camera.ymag = static_cast<float>(static_cast<double>(camera.ymag) / factor);
  return camera;
}

/// Returns the camera moved around the point at which it looks.
Camera turn(const Scene& scene, const Camera& camera, const PoseOptions& pose) {
  if (pose.orbit == Orbit()) return camera;
  const dvec3 target = pose.look_at ? *pose.look_at - scene.center : orbit_target(scene, camera);
  return orbit_camera(camera, target, pose.orbit, vec3(pose.up.value_or(dvec3(0.0, 1.0, 0.0))));
}

/// Returns a camera at the eye that the user gave.
Camera stand_at_eye(const Scene& scene, const PoseOptions& pose) {
  Camera camera;
  camera.name = "eye";
  camera.yfov = to_yfov(kEyeFovDeg);
  camera.eye = vec3(*pose.eye - scene.center);
  std::optional<dvec3> direction = find_direction(pose, camera, scene.center);
  if (!direction) {
    const Bounds bounds = frame_of(scene);
    direction = middle_of(bounds) + scene.center - *pose.eye;
    // The tolerance is needed because the bounds of shapes are rounded to fp32.
    if (glm::length(*direction) <= 1e-6 * glm::length(dvec3(bounds.extent()))) {
      throw UsageError({"camera.eye.middle",
                        "--eye is at the middle of the scene, so promin cannot derive a direction of view", "",
                        "give --look-at or --direction as well"});
    }
  }
  face(camera, direction, pose.up);
  camera = turn(scene, camera, pose);
  if (pose.fov_deg) camera.yfov = to_yfov(*pose.fov_deg);
  return camera;
}

/// Returns a camera that frames the scene, with `shows_all_sides` from all positions around it.
Camera frame(const Scene& scene, const PoseOptions& pose, float aspect_ratio, bool shows_all_sides) {
  const bool is_turned = pose.looks() || pose.orbit != Orbit() || pose.fov_deg || shows_all_sides;
  FrameOptions options{.from = pose.from, .fit = pose.fit.value_or(kDefaultFit)};
  if (is_turned || pose.fit) options.from = choose_framing(scene, pose);
  if (pose.up) options.up = vec3(*pose.up);
  Camera camera = frame_scene(scene, aspect_ratio, options);
  if (!is_turned) return camera;
  if (pose.direction) face(camera, pose.direction, pose.up);
  if (!pose.look_at) camera = turn(scene, camera, pose);
  if (pose.fov_deg) camera.yfov = to_yfov(*pose.fov_deg);
  if (options.from != Framing::kInside) {
    camera = shows_all_sides ? fit_turning_camera(scene, camera, options.up, aspect_ratio, options.fit)
                             : fit_camera(scene, camera, aspect_ratio, options.fit);
  }
  if (!pose.look_at) return camera;
  face(camera, find_direction(pose, camera, scene.center), pose.up);
  return turn(scene, camera, pose);
}

}  // namespace

const Camera* find_file_camera(const Scene& scene, const ViewOptions& options) {
  if (options.given_camera) return nullptr;
  if (options.camera) return &find_camera(scene, *options.camera);
  const bool is_framed = options.pose.from || options.pose.fit || options.frames_scene;
  return scene.cameras.empty() || is_framed ? nullptr : &scene.cameras.front();
}

Framing choose_framing(const Scene& scene, const PoseOptions& pose) {
  if (pose.from) return *pose.from;
  // If the user gives the covered fraction or a direction, the whole scene must be visible.
  return pose.fit || pose.direction ? Framing::kThreeQuarter : framing_of(scene);
}

bool is_camera_assumed(const Scene& scene, const ViewOptions& options) {
  const PoseOptions& pose = options.pose;
  const bool is_given = options.given_camera || options.camera || pose.eye || pose.from || pose.direction;
  return scene.cameras.empty() && !is_given;
}

Camera make_camera(const Scene& scene, const ViewOptions& options, float aspect_ratio) {
  if (options.given_camera) return *options.given_camera;
  const PoseOptions& pose = options.pose;
  Camera camera = pose.eye ? stand_at_eye(scene, pose) : frame(scene, pose, aspect_ratio, options.shows_all_sides);
  if (pose.near) camera.near = static_cast<float>(*pose.near);
  return zoom(camera, pose.zoom);
}

Camera turn_around(const Scene& scene, const ViewOptions& options, const Camera& camera, double steps,
                   uint32_t step_count) {
  constexpr double kTurnDeg = 360.0;
  const PoseOptions& pose = options.pose;
  const bool is_framed = !pose.eye && find_file_camera(scene, options) == nullptr;
  const dvec3 target = pose.look_at ? *pose.look_at - scene.center
                       : is_framed  ? middle_of(frame_of(scene))
                                    : orbit_target(scene, camera);
  return orbit_camera(camera, target, {.azimuth_deg = kTurnDeg * steps / step_count},
                      vec3(pose.up.value_or(dvec3(0.0, 1.0, 0.0))));
}

Camera pose_camera(const Scene& scene, const Camera& own, const PoseOptions& pose, const uvec2& size,
                   const Messages& console) {
  Camera camera = widen_camera(own, size);
  if (pose.eye) camera.eye = vec3(*pose.eye - scene.center);
  face(camera, find_direction(pose, camera, scene.center), pose.up);
  if (pose.fov_deg) {
    // A camera with an eye and a direction from the user is the user's own camera.
    if (camera.projection == Projection::kOrthographic && !(pose.eye && pose.looks())) {
      console.note("the camera is orthographic; --fov makes it perspective");
    }
    camera.projection = Projection::kPerspective;
    camera.yfov = to_yfov(*pose.fov_deg);
  }
  camera = turn(scene, camera, pose);
  if (pose.near) camera.near = static_cast<float>(*pose.near);
  return zoom(camera, pose.zoom);
}

std::string describe_empty_pictures(const Scene& scene, std::span<const Camera> cameras, const uvec2& size) {
  const float aspect_ratio = static_cast<float>(size.x) / static_cast<float>(size.y);
  if (std::ranges::any_of(cameras, [&](const Camera& camera) { return may_see(scene, camera, aspect_ratio); }))
    return "";
  if (bounds_of(scene).is_empty()) return "";  // The loader has already reported this.
  const dvec3 middle = middle_of(frame_of(scene)) + scene.center;
  return fmt::format(
      "the picture shows nothing of the scene; --look-at {:.6g} {:.6g} {:.6g} instead of a direction looks at its "
      "middle, and --from three-quarter instead of all other options of the camera shows all of it",
      middle.x, middle.y, middle.z);
}

bool is_file_camera_unchanged(const Scene& scene, const ViewOptions& options) {
  return !options.camera && !options.pose.any() && find_file_camera(scene, options) != nullptr;
}

std::string describe_file_camera(const Scene& scene, const ViewOptions& options, const View& view) {
  // The largest fraction of the picture for which a note says that the author's camera shows the model small.
  constexpr double kSmall = 0.4;
  // A model that covers more than this is one in which the camera stands, or of which it shows a detail.
  constexpr double kLarge = 1.5;
  if (!is_file_camera_unchanged(scene, options)) return "";
  const double share =
      covered_share(scene, view.camera, static_cast<float>(view.size.x) / static_cast<float>(view.size.y));
  if (bounds_of(scene).is_empty()) return "";
  if (share > 1.0 && share <= kLarge)
    return "the file's camera does not show the whole model; --from three-quarter frames it";
  if (share >= kSmall) return "";
  return fmt::format(
      "the model covers only {:.0f} % of the picture's side in the file's camera; --from three-quarter frames it",
      100.0 * share);
}

void warn_of_empty_pictures(const Scene& scene, std::span<const Camera> cameras, const uvec2& size,
                            const Messages& console) {
  const std::string sentence = describe_empty_pictures(scene, cameras, size);
  if (!sentence.empty()) console.warn(sentence);
}

}  // namespace promin::work
