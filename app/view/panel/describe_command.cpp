// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/panel/describe_command.h"

#include <fmt/ranges.h>

namespace promin::app {
namespace {

std::string words_of(const vec3& v) {
  return fmt::format("{} {} {}", v.x, v.y, v.z);
}

/// Returns a place in the scene in world coordinates.
std::string words_of(const vec3& place, const dvec3& center) {
  if (center == dvec3(0.0)) return words_of(place);
  const dvec3 world = center + dvec3(place);
  return fmt::format("{} {} {}", world.x, world.y, world.z);
}

std::string quote(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string samples_of(const View& view) {
  if (!view.error_target) return fmt::format(" --spp {}", view.samples_per_pixel);
  return fmt::format(" {}", describe_options(*view.error_target));
}

std::string options_of(const EnvironmentOptions& environment) {
  std::string options;
  if (environment.panorama) options += " --environment " + quote(environment.panorama->string());
  if (environment.rotation_deg != 0.0) options += fmt::format(" --environment-rotation {}", environment.rotation_deg);
  if (environment.intensity != 1.0) options += fmt::format(" --environment-intensity {}", environment.intensity);
  if (environment.light_rotation_deg != 0.0)
    options += fmt::format(" --light-rotation {}", environment.light_rotation_deg);
  return options;
}

std::string word_of(const BackgroundChoice& background) {
  if (background.is_environment) return "environment";
  const vec3& color = background.color;
  return background.is_linear ? fmt::format("linear:{},{},{}", color.x, color.y, color.z) : words_of(color);
}

/// Returns the options of a look. The framing is not among them, because the command has a pose.
std::string options_of(const LookOptions& look) {
  std::string options;
  if (look.light != LightChoice::kAuto) {
    options += fmt::format(" --light {}", light_choice_names()[static_cast<size_t>(look.light)]);
  }
  if (look.has_ground) options += *look.has_ground ? " --ground on" : " --ground off";
  if (look.background) {
    options += " --background " + word_of(*look.background);
  }
  if (look.exposure_ev) options += fmt::format(" --exposure {}", *look.exposure_ev);
  if (look.tone_mapping) {
    options += fmt::format(" --tone-mapping {}", tone_mapping_names()[static_cast<size_t>(*look.tone_mapping)]);
  }
  if (look.dithers) options += " --dither";
  if (look.texture_memory_mib != LookOptions().texture_memory_mib) {
    options += fmt::format(" --texture-memory {}", look.texture_memory_mib);
  }
  return options;
}

}  // namespace

std::optional<size_t> find_half_height(const Scene& scene, const Camera& camera) {
  if (camera.projection == Projection::kPerspective) return std::nullopt;
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& other = scene.cameras[i];
    if (other.projection == camera.projection && other.ymag == camera.ymag) return i;
  }
  return std::nullopt;
}

bool can_describe(const DescribedScene& scene, const View& view) {
  return view.camera.projection == Projection::kPerspective || scene.camera_index;
}

std::string describe_command(const DescribedScene& scene, const View& view) {
  const Camera& camera = view.camera;
  std::string command = fmt::format("promin render {} -o {} --size {} {}{} --max-depth {}", quote(scene.file.string()),
                                    scene.output ? quote(scene.output->string()) : "view.exr", view.size.x, view.size.y,
                                    samples_of(view), view.max_depth);
  if (view.filter != PixelFilter::kBox || view.filter_width != default_width(view.filter)) {
    command += fmt::format(" --filter {} --filter-width {}", pixel_filter_names()[static_cast<size_t>(view.filter)],
                           view.filter_width);
  }
  if (view.seed != 0) command += fmt::format(" --seed {}", view.seed);
  if (view.occlusion_distance != 0.0F) command += fmt::format(" --occlusion-distance {}", view.occlusion_distance);
  if (view.mode.debug_view != DebugView::kNone) {
    command += fmt::format(" --shading {}", debug_view_names()[static_cast<size_t>(view.mode.debug_view)]);
  }
  if (!scene.has_shadows) command += " --no-shadows";
  // The usual integrator is that of the pose in which the scene was opened.
  if (view.mode.integrator != Integrator::kWhitted || scene.usual_integrator != Integrator::kWhitted ||
      scene.motion.time_s) {
    command += fmt::format(" --integrator {}", integrator_names()[static_cast<size_t>(view.mode.integrator)]);
  }
  if (!scene.lights_off.empty()) command += fmt::format(" --lights-off {}", fmt::join(scene.lights_off, ","));
  command += options_of(scene.look) + options_of(scene.environment);
  if (scene.motion.time_s) command += fmt::format(" --time {}", *scene.motion.time_s);
  for (const std::string& animation : scene.motion.animations) command += " --animation " + quote(animation);
  if (scene.motion.loops) command += " --loop";
  if (!scene.variant.empty()) command += " --variant " + quote(scene.variant);
  if (!scene.root.empty()) command += " --root " + quote(scene.root.string());
  if (scene.camera_index) command += fmt::format(" --camera {}", *scene.camera_index);
  command += fmt::format(" --eye {} --direction {} --up {}", words_of(camera.eye, scene.center), words_of(camera.look),
                         words_of(camera.up));
  if (camera.projection == Projection::kPerspective) {
    // Nine digits of an angle in degrees are accurate to half of a float's last place.
    command += fmt::format(" --fov {:.9g}", glm::degrees(static_cast<double>(camera.yfov)));
  }
  command += fmt::format(" --near {}", camera.near);
  if (has_lens(camera)) {
    command += fmt::format(" --aperture-radius {} --focus-distance {}", camera.aperture_radius, camera.focus_distance);
  }
  // Hits on instances and on copies differ in some bits.
  if (scene.instances != Instancing::kAuto) {
    command += fmt::format(" --instances {}", instancing_names()[static_cast<size_t>(scene.instances)]);
  }
  // Only the picture of steps depends on the tree.
  if (view.mode.debug_view != DebugView::kSteps) return command;
  return command + (scene.bvh ? " --bvh " + quote(scene.bvh->string()) : " --builder " + scene.builder);
}

}  // namespace promin::app
