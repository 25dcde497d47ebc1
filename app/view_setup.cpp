// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view_setup.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <variant>
#include <vector>

#include "camera.h"
#include "promin/error.h"

namespace promin::app {
namespace {

constexpr uint32_t kDefaultHeight = 720;

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

Framing choose_framing(const Scene& scene, const LookOptions& look) {
  return look.framing.value_or(framing_of(scene));
}

Camera choose_camera(const Scene& scene, const ViewOptions& options) {
  if (options.given_camera) return *options.given_camera;
  if (options.camera) return find_camera(scene, *options.camera);
  if (!scene.cameras.empty()) return scene.cameras.front();
  const bool has_both = options.size && options.size->x > 0 && options.size->y > 0;
  return frame_scene(
      scene, has_both ? static_cast<float>(options.size->x) / static_cast<float>(options.size->y) : kDefaultAspectRatio,
      choose_framing(scene, options.look));
}

/// Whether the view's camera is one that frames the scene, and nobody has said from where.
bool is_camera_assumed(const Scene& scene, const ViewOptions& options) {
  const bool is_given = options.given_camera || options.camera || (options.pose.eye && options.pose.look);
  return scene.cameras.empty() && !is_given && !options.look.framing;
}

void apply_pose(Camera& camera, const PoseOptions& pose, const dvec3& center, const Console& console) {
  if (pose.eye) camera.eye = vec3(*pose.eye - center);
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

/// The size with the side that the user has left open, by the aspect ratio of the size that the camera would have.
std::optional<uvec2> complete_size(const uvec2& sides, const std::optional<uvec2>& usual) {
  if (sides.x > 0 && sides.y > 0) return sides;
  if (!usual) return {};
  const dvec2 ratio = dvec2(*usual) / dvec2(usual->y, usual->x);
  const dvec2 size(sides.x > 0 ? sides.x : std::round(sides.y * ratio.x),
                   sides.y > 0 ? sides.y : std::round(sides.x * ratio.y));
  if (!(std::min(size.x, size.y) >= 1.0 && std::max(size.x, size.y) <= kMaxSide)) return {};
  return uvec2(size);
}

uvec2 choose_size(const ViewOptions& options, const Camera& camera, const Scene& scene) {
  const std::optional<uvec2> usual = default_size(camera);
  const std::optional<uvec2> size = options.size ? complete_size(*options.size, usual) : usual;
  if (size) return *size;
  throw UsageError({fmt::format("the camera's aspect ratio of {} gives no sensible width", camera.aspect_ratio),
                    scene.file.string(), "give --size"});
}

}  // namespace

std::optional<uvec2> default_size(const Camera& camera) {
  if (camera.resolution != uvec2(0)) return camera.resolution;
  const float aspect_ratio = camera.aspect_ratio > 0.0F ? camera.aspect_ratio : kDefaultAspectRatio;
  const double width = std::round(static_cast<double>(kDefaultHeight) * static_cast<double>(aspect_ratio));
  if (!(width >= 1.0 && width <= kMaxSide)) return {};
  return uvec2(static_cast<uint32_t>(width), kDefaultHeight);
}

View make_view(const Scene& scene, const ViewOptions& options, const Console& console) {
  View view;
  view.camera = choose_camera(scene, options);
  view.size = choose_size(options, view.camera, scene);
  apply_pose(view.camera, options.pose, scene.center, console);
  view.crop = options.crop;
  if (view.crop && (view.crop->hi.x > view.size.x || view.crop->hi.y > view.size.y)) {
    throw UsageError({fmt::format("--crop reaches beyond the picture of {}x{}", view.size.x, view.size.y),
                      "on the command line", "stay within it or give a larger --size"});
  }
  view.samples_per_pixel = options.samples_per_pixel.value_or(View{}.samples_per_pixel);
  view.filter = options.filter;
  view.filter_width = options.filter_width.value_or(default_width(options.filter));
  view.max_depth = options.max_depth.value_or(default_max_depth(scene));
  view.mode = {options.debug_view, !options.has_no_shadows};
  view.depth_kind = options.depth_kind;
  return view;
}

AssumedLight light_up(Scene& scene, const LookOptions& look, const EnvironmentChoice& surroundings) {
  surroundings.replace_sky(scene);
  AssumedLight assumed = light_scene(scene, look.light);
  surroundings.adjust_sky(scene);
  if (!look.background) return assumed;
  assumed.has_background = false;
  Environment& environment = scene.environment;
  environment.shows_sky = look.background->is_environment && environment.has_sky();
  // Without a sky what surrounds the scene is its ambient light.
  environment.background = look.background->is_environment ? environment.ambient : look.background->color;
  return assumed;
}

DisplayTransform choose_display(const Scene& scene, const LookOptions& look, DebugView debug_view) {
  if (debug_view != DebugView::kNone) return {};
  DisplayTransform display = display_of(scene, look.light);
  if (look.exposure_ev) display.exposure_ev = *look.exposure_ev;
  if (look.tone_mapping) display.tone_mapping = *look.tone_mapping;
  display.dithers = look.dithers;
  return display;
}

std::string describe_framing(Framing framing) {
  return framing == Framing::kFront ? "a camera in front that frames the scene"
                                    : "a camera that frames the scene from three quarters";
}

std::string describe_light(const AssumedLight& light) {
  if (light.has_studio_light) return "the light of a studio";
  if (light.has_studio) return "a studio's weaker light around the scene's own";
  if (light.has_ambient) return fmt::format("a headlight along the view and ambient light of {}", kDefaultAmbient);
  return light.has_headlight ? "a headlight along the view" : "";
}

std::vector<std::string> list_assumptions(const Scene& scene, const ViewOptions& options, const AssumedLight& light,
                                          const std::optional<DisplayTransform>& display) {
  const LookOptions& look = options.look;
  std::vector<std::string> parts;
  if (is_camera_assumed(scene, options)) parts.push_back(describe_framing(choose_framing(scene, look)));
  if (look.light == LightChoice::kAuto && !describe_light(light).empty()) parts.push_back(describe_light(light));
  if (light.has_background) parts.emplace_back("a grey background");
  if (display && !look.exposure_ev && !look.averages_exposure && display->exposure_ev != 0.0F) {
    parts.push_back(fmt::format("an exposure of {:+g} EV", display->exposure_ev));
  }
  if (display && !look.tone_mapping && display->tone_mapping != ToneMapping::kNone) {
    parts.push_back(fmt::format("tone mapping {}", tone_mapping_names()[static_cast<size_t>(display->tone_mapping)]));
  }
  return parts;
}

std::string describe_assumptions(const Scene& scene, const ViewOptions& options, const AssumedLight& light,
                                 const std::optional<DisplayTransform>& display) {
  const std::vector<std::string> parts = list_assumptions(scene, options, light, display);
  return parts.empty() ? "" : fmt::format("assumed: {}", fmt::join(parts, ", "));
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
