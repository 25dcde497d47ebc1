// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/view_setup.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "image/color_words.h"
#include "promin/error.h"
#include "scene/framing.h"
#include "work/pictures/camera_choice.h"
#include "work/pictures/ground.h"
#include "work/pictures/usual_integrator.h"

namespace promin::work {
namespace {

constexpr uint32_t kDefaultHeight = 720;

/// Returns the aspect ratio of the picture that the options request, as far as it is known.
float aspect_ratio_of(const ViewOptions& options) {
  const uvec2 size = options.size.value_or(uvec2(0));
  return size.x > 0 && size.y > 0 ? static_cast<float>(size.x) / static_cast<float>(size.y) : kDefaultAspectRatio;
}

/// Returns the size with a missing side computed from the aspect ratio of the camera's default size.
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
  if (const auto size = size_for(options.size.value_or(uvec2(0)), camera)) return *size;
  throw UsageError({"camera.aspect",
                    fmt::format("the camera's aspect ratio of {} is too extreme to compute the width of the picture",
                                camera.aspect_ratio),
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

std::optional<uvec2> size_for(const uvec2& sides, const Camera& camera) {
  const std::optional<uvec2> usual = default_size(camera);
  return sides == uvec2(0) ? usual : complete_size(sides, usual);
}

RenderMode mode_of(const Scene& scene, const ViewOptions& options) {
  const Integrator integrator = options.integrator ? *options.integrator : usual_integrator(scene, options.look.light);
  return {options.debug_view, !options.has_no_shadows, integrator};
}

void put_lens(const ViewOptions& options, Camera& camera) {
  if (options.aperture_radius) camera.aperture_radius = static_cast<float>(*options.aperture_radius);
  if (options.focus_distance) camera.focus_distance = static_cast<float>(*options.focus_distance);
}

View make_view(const Scene& scene, const ViewOptions& options, const Messages& console) {
  View view;
  const Camera* own = find_file_camera(scene, options);
  view.camera = own != nullptr ? *own : make_camera(scene, options, aspect_ratio_of(options));
  view.size = choose_size(options, view.camera, scene);
  if (own != nullptr) view.camera = pose_camera(scene, *own, options.pose, view.size, console);
  put_lens(options, view.camera);
  view.crop = options.crop;
  if (view.crop && (view.crop->hi.x > view.size.x || view.crop->hi.y > view.size.y)) {
    throw UsageError({"view.crop.outside",
                      fmt::format("--crop extends beyond the picture of {}x{} pixels", view.size.x, view.size.y), "",
                      "use a crop inside the picture, or give a larger --size"});
  }
  view.samples_per_pixel = options.samples_per_pixel.value_or(View{}.samples_per_pixel);
  view.filter = options.filter;
#define PROMIN_VIEW_NUMBER(NAME, TYPE, MIN, MAX, USUAL, PLACEHOLDER, HELP) view.NAME = options.NAME.value_or(USUAL);
#include "work/spec/view_numbers.def"
  view.mode = mode_of(scene, options);
  view.depth_kind = options.depth_kind;
  return view;
}

std::optional<vec3> upward_direction(const Scene& scene, const ViewOptions& options) {
  const PoseOptions& pose = options.pose;
  const bool has_camera = options.given_camera || options.camera || pose.eye;
  const bool is_framed = pose.from || pose.fit || options.frames_scene || scene.cameras.empty();
  if (!pose.up || has_camera || !is_framed) return {};
  return vec3(normalize_up(vec3(*pose.up)));
}

AssumedLight light_up(Scene& scene, const LookOptions& look, const EnvironmentChoice& surroundings,
                      const std::optional<vec3>& up) {
  if (up) scene.environment.up = *up;
  AssumedLight assumed = light_scene(scene, look.light, look.surface_lux);
  surroundings.adjust_sky(scene);
  if (look.background) {
    assumed.has_background = false;
    show_background(*look.background, scene.environment);
  }
  if (look.wants_ground()) add_ground(scene);
  return assumed;
}

void show_background(const BackgroundChoice& background, Environment& environment) {
  environment.shows_sky = background.is_environment && environment.has_sky();
  environment.backdrop.reset();
  if (background.is_environment) {
    // If the scene has no sky, its environment is the ambient light.
    environment.background = environment.ambient;
  } else if (background.is_linear) {
    environment.background = background.color;
  } else {
    const vec3 light = linear_of_srgb(background.color);
    environment.background = light;
    environment.backdrop = Backdrop{light, light};
  }
}

DisplayTransform choose_display(const Scene& scene, const LookOptions& look, DebugView debug_view) {
  if (debug_view != DebugView::kNone) return {};
  DisplayTransform display = display_of(scene, look.light, look.surface_lux);
  if (look.exposure_ev) display.exposure_ev = *look.exposure_ev;
  if (look.tone_mapping) display.tone_mapping = *look.tone_mapping;
  display.dithers = look.dithers;
  return display;
}

bool shows_unlit_apart(const Scene& scene, const Environment& environment, const LookOptions& look,
                       const DisplayTransform& display) {
  const bool shows_light_as_it_is = display.exposure_ev == 0.0F && display.tone_mapping == ToneMapping::kNone;
  return mixes_unlit(scene, environment) && (look.averages_exposure || !shows_light_as_it_is);
}

std::string describe_framing(const Scene& scene, const PoseOptions& pose) {
  const Framing framing = choose_framing(scene, pose);
  if (framing == Framing::kInside) return "a camera that stands inside the scene";
  if (framing != Framing::kThreeQuarter) {
    return fmt::format("a camera that looks into the scene from the {}", framing_names()[static_cast<size_t>(framing)]);
  }
  const vec3 up = pose.up ? vec3(*pose.up) : FrameOptions().up;
  const Camera camera = frame_scene(scene, 1.0F, {.from = framing, .up = up});
  const bool is_level = std::abs(glm::dot(camera.look, glm::normalize(up))) < 1e-3F;
  return is_level ? "a camera that frames the scene from the front, because it is flat"
                  : "a camera that frames the scene from three quarters";
}

std::string describe_light(const AssumedLight& light) {
  if (light.has_studio_light) return "the light of a studio";
  if (light.has_studio) return "weak studio light in addition to the scene's own";
  if (light.has_ambient) return fmt::format("a headlight along the view and ambient light of {}", kDefaultAmbient);
  return light.has_headlight ? "a headlight along the view" : "";
}

std::vector<std::string> list_assumptions(const Scene& scene, const ViewOptions& options, const AssumedLight& light,
                                          Integrator integrator, const std::optional<DisplayTransform>& display) {
  const LookOptions& look = options.look;
  std::vector<std::string> parts;
  if (is_camera_assumed(scene, options)) parts.push_back(describe_framing(scene, options.pose));
  if (scene.cameras.size() > 1 && is_file_camera_unchanged(scene, options))
    parts.push_back(fmt::format("the first of the file's {} cameras", scene.cameras.size()));
  if (look.light == LightChoice::kAuto && !describe_light(light).empty()) parts.push_back(describe_light(light));
  if (!options.integrator && look.light != LightChoice::kSoft && integrator == Integrator::kDirect) {
    parts.emplace_back("light from emissive surfaces (--integrator direct)");
  }
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
                                 Integrator integrator, const std::optional<DisplayTransform>& display) {
  const std::vector<std::string> parts = list_assumptions(scene, options, light, integrator, display);
  return parts.empty() ? "" : fmt::format("assumed: {}", fmt::join(parts, ", "));
}

void check_lights(const Scene& scene, const std::vector<uint32_t>& indices) {
  for (const uint32_t index : indices) {
    if (index < scene.lights.size()) continue;
    throw UsageError({"light.unknown", fmt::format("the scene has no light {} to switch off", index),
                      scene.file.string(),
                      fmt::format("the number of lights is {}, and the first light is number 0", scene.lights.size())});
  }
}

void switch_lights(std::vector<Light>& lights, const std::vector<uint32_t>& off) {
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (std::find(off.begin(), off.end(), i) != off.end()) lights[i].is_on = false;
  }
}

}  // namespace promin::work
