// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "camera.h"
#include "promin/error.h"

namespace promin::app {
namespace {

constexpr uint32_t kDefaultHeight = 720;
constexpr float kDefaultAspectRatio = 16.0F / 9.0F;

std::string list_cameras(const Scene& scene) {
  std::string text;
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", i);
    if (!scene.cameras[i].name.empty()) text += fmt::format(" ({})", scene.cameras[i].name);
  }
  return text;
}

/// The name is tried first, because a camera may be called "2".
const Camera& find_camera(const Scene& scene, const std::string& selection) {
  if (scene.cameras.empty()) {
    throw UsageError({"the scene has no cameras to choose from", scene.file.string(), "leave --camera out"});
  }
  for (const Camera& camera : scene.cameras) {
    if (camera.name == selection) return camera;
  }
  size_t index = 0;
  const char* end = selection.data() + selection.size();
  const auto [rest, error] = std::from_chars(selection.data(), end, index);
  if (error != std::errc() || rest != end || index >= scene.cameras.size()) {
    throw UsageError({"no camera \"" + selection + "\"", scene.file.string(), "choose one of: " + list_cameras(scene)});
  }
  return scene.cameras[index];
}

Camera choose_camera(const Scene& scene, const ViewOptions& options, const Console& console) {
  if (options.given_camera) return *options.given_camera;
  if (options.camera) return find_camera(scene, *options.camera);
  if (!scene.cameras.empty()) return scene.cameras.front();
  if (!options.pose.eye || !options.pose.look) {
    console.note("the scene has no camera; one that frames it is used");
  }
  return frame_scene(scene, options.size ? static_cast<float>(options.size->x) / static_cast<float>(options.size->y)
                                         : kDefaultAspectRatio);
}

void apply_pose(Camera& camera, const PoseOptions& pose, const Console& console) {
  if (pose.eye) camera.eye = vec3(*pose.eye);
  if (pose.look || pose.up) {
    const dvec3 default_up = pose.look ? dvec3(0.0, 1.0, 0.0) : dvec3(camera.up);
    const Camera posed = FreeCamera::from_pose(camera.eye, vec3(pose.look.value_or(dvec3(camera.look))),
                                               vec3(pose.up.value_or(default_up)))
                             .camera();
    camera.look = posed.look;
    camera.up = posed.up;
  }
  if (pose.fov_deg) {
    // With eye and look it is a camera of the user's own.
    if (camera.projection == Projection::kOrthographic && !(pose.eye && pose.look)) {
      console.note("the camera is orthographic; --fov makes it a perspective one");
    }
    camera.projection = Projection::kPerspective;
    camera.yfov = static_cast<float>(glm::radians(*pose.fov_deg));
  }
  if (pose.near) camera.near = static_cast<float>(*pose.near);
}

uvec2 choose_size(const ViewOptions& options, const Camera& camera, const Scene& scene) {
  if (options.size) return *options.size;
  const float aspect_ratio = camera.aspect_ratio > 0.0F ? camera.aspect_ratio : kDefaultAspectRatio;
  const double width = std::round(static_cast<double>(kDefaultHeight) * static_cast<double>(aspect_ratio));
  if (!(width >= 1.0 && width <= kMaxSide)) {
    throw UsageError({fmt::format("the camera's aspect ratio of {} gives no sensible width", aspect_ratio),
                      scene.file.string(), "give --size"});
  }
  return {static_cast<uint32_t>(width), kDefaultHeight};
}

}  // namespace

View make_view(const Scene& scene, const ViewOptions& options, const Console& console) {
  View view;
  view.camera = choose_camera(scene, options, console);
  view.size = choose_size(options, view.camera, scene);
  apply_pose(view.camera, options.pose, console);
  view.crop = options.crop;
  if (view.crop && (view.crop->hi.x > view.size.x || view.crop->hi.y > view.size.y)) {
    throw UsageError({fmt::format("--crop reaches beyond the picture of {}x{}", view.size.x, view.size.y),
                      "on the command line", "stay within it or give a larger --size"});
  }
  view.samples_per_pixel = options.samples_per_pixel;
  view.max_depth = options.max_depth;
  view.mode = {options.debug_view, !options.has_no_shadows};
  return view;
}

void light_up(Scene& scene, const Console& console) {
  const AddedLights added = add_default_lights(scene);
  if (!added.has_headlight) return;
  if (!added.has_ambient) {
    console.note("the scene has no lights; a headlight along the view is used");
    return;
  }
  console.note(fmt::format("the scene has no lights; a headlight along the view and ambient light of {} are used",
                           kDefaultAmbient));
}

void check_lights(const Scene& scene, const std::vector<uint32_t>& indices) {
  for (const uint32_t index : indices) {
    if (index < scene.lights.size()) continue;
    throw UsageError({fmt::format("no light {} to leave out", index), scene.file.string(),
                      fmt::format("it has {}, and the first is 0", scene.lights.size())});
  }
}

void switch_lights(std::vector<Light>& lights, const std::vector<uint32_t>& off) {
  for (uint32_t i = 0; i < lights.size(); ++i) {
    lights[i].is_on = std::find(off.begin(), off.end(), i) == off.end();
  }
}

}  // namespace promin::app
